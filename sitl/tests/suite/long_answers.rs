//! Long answers: sent in slices as links have room, to one peer after the other, whatever is asked in between; and work on files, which
//! is done when the worker gets to it.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use crate::common::ftp_client::*;
use crate::common::{Bench, command_long};
use autopilot::codec::Message;
use autopilot::envelope::{Destination, Origin, PeerId};
use autopilot::file_store::{Access, FileError, FileStore, Listed, OpenFile};
use autopilot::file_work::{FileJob, FileWorker, Immediate, JobStep, QueueFull};
use mavlink::dialects::ardupilotmega::{
    LOG_REQUEST_LIST_DATA, MavCmd, MavMessage, PARAM_REQUEST_LIST_DATA, PARAM_SET_DATA,
};
use sitl::files::Disk;
use vehicle::identity::Identity;

fn list_parameters() -> MavMessage {
    MavMessage::PARAM_REQUEST_LIST(PARAM_REQUEST_LIST_DATA { target_system: 1, target_component: 1 })
}

fn list_logs() -> MavMessage {
    let (target_system, target_component) = (1, 1);
    MavMessage::LOG_REQUEST_LIST(LOG_REQUEST_LIST_DATA {
        start: 0,
        end: u16::MAX,
        target_system,
        target_component,
    })
}

/// A bench whose long answers go as far as the test says.
fn paced() -> Bench {
    let mut bench = Bench::new(Identity::Px4);
    bench.turns = 0;
    bench.heard.clear();
    bench
}

fn peer(number: u64) -> PeerId {
    PeerId { link: 0, number }
}

fn receive_from(bench: &mut Bench, number: u64, message: MavMessage) {
    let frame = bench.frame(message);
    let origin = Origin { peer: peer(number), ..Bench::origin() };
    bench.autopilot.receive(&origin, &frame);
}

/// Indices of the parameters that go out in some turns, with their peers.
fn values(bench: &mut Bench, turns: usize, room: impl Fn(PeerId) -> Option<bool>) -> Vec<(PeerId, u16)> {
    bench.autopilot.transfer(turns, room);
    let sent = bench.autopilot.take_outgoing();
    sent.filter_map(|outgoing| match (outgoing.to, outgoing.message) {
        (Destination::Peer(peer), Message::Typed(MavMessage::PARAM_VALUE(value))) => {
            Some((peer, value.param_index))
        }
        _ => None,
    })
    .collect()
}

const HASH: u16 = u16::MAX;

#[test]
fn a_list_of_parameters_goes_in_slices_and_begins_again_when_asked_again() {
    let mut bench = paced();
    let count = bench.autopilot.parameters().count();
    let room = |_| Some(true);
    // Asking a thousand times costs one list.
    for _ in 0..1000 {
        receive_from(&mut bench, 1, list_parameters());
    }
    assert!(values(&mut bench, 0, room).is_empty(), "nothing is sent where a message is received");
    let indices = |sent: Vec<(PeerId, u16)>| sent.into_iter().map(|(_, index)| index).collect::<Vec<_>>();
    assert_eq!(indices(values(&mut bench, 3, room)), [HASH, 0, 1]);
    assert!(values(&mut bench, 10, |_| Some(false)).is_empty(), "a link without room");
    receive_from(&mut bench, 1, list_parameters());
    let all: Vec<u16> = std::iter::once(HASH).chain(0..count as u16).collect();
    assert_eq!(indices(values(&mut bench, 10_000, room)), all);
    assert!(values(&mut bench, 10, room).is_empty());
    // Peers take turns; a client with a valid cache stops its list, one that is gone needs none.
    for number in [1, 2, 3] {
        receive_from(&mut bench, number, list_parameters());
    }
    let sent = values(&mut bench, 6, room);
    assert_eq!(
        sent,
        [(2, HASH), (3, HASH), (1, HASH), (2, 0), (3, 0), (1, 0)].map(|(to, index)| (peer(to), index))
    );
    let cached = PARAM_SET_DATA {
        target_system: 1,
        target_component: 1,
        param_id: "_HASH_CHECK".into(),
        ..PARAM_SET_DATA::default()
    };
    receive_from(&mut bench, 1, MavMessage::PARAM_SET(cached));
    let rest = values(&mut bench, 10_000, |to| (to != peer(2)).then_some(true));
    assert_eq!(rest, (1..count as u16).map(|index| (peer(3), index)).collect::<Vec<_>>());
}

/// A store that counts how often its folders are read.
#[derive(Debug)]
struct Counting(Disk, Arc<AtomicUsize>);

impl FileStore for Counting {
    fn list(&self, path: &str) -> Result<Vec<Listed>, FileError> {
        self.1.fetch_add(1, Ordering::SeqCst);
        if path == "logs" {
            let log =
                |number| Listed { name: format!("{number:05}"), size: Some(number), modified_unix_s: 0 };
            return Ok((0..1000).map(log).collect());
        }
        self.0.list(path)
    }

    fn open(&mut self, path: &str, access: Access) -> Result<Box<dyn OpenFile>, FileError> {
        self.0.open(path, access)
    }

    fn remove_file(&mut self, path: &str) -> Result<(), FileError> {
        self.0.remove_file(path)
    }

    fn create_folder(&mut self, path: &str) -> Result<(), FileError> {
        self.0.create_folder(path)
    }

    fn remove_folder(&mut self, path: &str) -> Result<(), FileError> {
        self.0.remove_folder(path)
    }

    fn rename(&mut self, from: &str, to: &str) -> Result<(), FileError> {
        self.0.rename(from, to)
    }

    fn truncate(&mut self, path: &str, size: u64) -> Result<(), FileError> {
        self.0.truncate(path, size)
    }

    fn erase_logs(&mut self) -> Result<(), FileError> {
        self.0.erase_logs()
    }
}

fn counting(root: &std::path::Path) -> (Counting, Arc<AtomicUsize>) {
    let listings = Arc::new(AtomicUsize::new(0));
    let disk = Disk::open(None, Some(&(root.to_owned(), true))).expect("a folder");
    (Counting(disk, Arc::clone(&listings)), listings)
}

#[test]
fn a_list_of_logs_goes_in_slices_and_one_look_serves_a_flood() {
    let folder = tempfile::tempdir().expect("a folder");
    let (store, listings) = counting(folder.path());
    let mut bench = paced();
    bench.autopilot.share(Box::new(Immediate(store)));
    for _ in 0..3000 {
        receive_from(&mut bench, 1, list_logs());
    }
    assert_eq!(listings.load(Ordering::SeqCst), 1);
    let entries = |bench: &mut Bench, turns| {
        bench.autopilot.transfer(turns, |_| Some(true));
        let sent = bench.autopilot.take_outgoing();
        sent.filter_map(|outgoing| match outgoing.message {
            Message::Typed(MavMessage::LOG_ENTRY(entry)) => Some(entry.id),
            _ => None,
        })
        .collect::<Vec<_>>()
    };
    assert_eq!(entries(&mut bench, 10), (0..10).collect::<Vec<_>>());
    assert_eq!(entries(&mut bench, 10_000), (10..1000).collect::<Vec<_>>());
    assert!(entries(&mut bench, 10_000).is_empty());
}

#[test]
fn a_listing_reads_its_folder_once_and_stays_as_it_was() {
    let folder = tempfile::tempdir().expect("a folder");
    for number in 0..300 {
        std::fs::write(folder.path().join(format!("{number:03}")), "").expect("written");
    }
    let (store, listings) = counting(folder.path());
    let mut bench = Bench::new(Identity::Px4);
    bench.autopilot.share(Box::new(Immediate(store)));
    let mut client = Client { bench, sequence: 0 };
    assert_eq!(client.list("/files").expect("a list").len(), 300);
    assert_eq!(listings.load(Ordering::SeqCst), 1);
    // What comes in the middle of a listing is in the next one.
    client.ask(LIST, 0, b"/files").expect("its beginning");
    std::fs::write(folder.path().join("0"), "").expect("written");
    assert_eq!(client.ask(LIST, 299, b"/files"), Ok(b"F299\t0\0".to_vec()));
    assert_eq!(client.ask(LIST, 300, b"/files"), Err(END));
    assert_eq!(client.list("/files").expect("a list").len(), 301);
    assert_eq!(listings.load(Ordering::SeqCst), 3);
}

/// A worker whose jobs are done when the test says so.
#[derive(Clone, Debug, Default)]
struct Later(Arc<Mutex<VecDeque<Box<dyn FileJob>>>>);

impl FileWorker for Later {
    fn submit(&mut self, _client: PeerId, job: Box<dyn FileJob>) -> Result<(), QueueFull> {
        self.0.lock().expect("one thread").push_back(job);
        Ok(())
    }
}

impl Later {
    /// Does a job. Returns its steps.
    fn work(&self, store: &mut dyn FileStore) -> usize {
        let job = self.0.lock().expect("one thread").pop_front();
        let mut job = job.expect("a job");
        1 + std::iter::repeat_with(|| job.advance(store)).take_while(|step| *step == JobStep::More).count()
    }

    fn waiting(&self) -> usize {
        self.0.lock().expect("one thread").len()
    }
}

#[test]
fn requests_are_carried_out_once_in_their_order_and_a_full_queue_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut disk = Disk::open(None, Some(&(folder.path().to_owned(), true))).expect("a folder");
    std::fs::write(folder.path().join("big"), vec![7; 5 << 20]).expect("written");
    let later = Later::default();
    let mut bench = Bench::new(Identity::Px4);
    bench.autopilot.share(Box::new(later.clone()));
    bench.heard.clear();
    let path = b"/files/new";
    let create = request(0, CREATE, 7, path.len() as u8, 0, path);
    // Retries of what is being worked on are one request.
    for _ in 0..5 {
        bench.send(create.clone());
    }
    assert_eq!(later.waiting(), 1);
    bench.send(request(2, WRITE, 7, 5, 0, b"hello"));
    bench.send(request(4, TERMINATE, 7, 0, 0, &[]));
    bench.send(request(6, CHECKSUM, 0, path.len() as u8, 0, path));
    bench.send(request(8, CHECKSUM, 0, 10, 0, b"/files/big"));
    assert!(answers(&bench.heard).is_empty());
    let steps: Vec<usize> = (0..5).map(|_| later.work(&mut disk)).collect();
    assert_eq!(steps[..4], [1, 1, 1, 2]);
    assert!(steps[4] > 5, "a checksum goes in slices: {steps:?}");
    bench.listen();
    let all = answers(&bench.heard);
    assert_eq!(all.iter().map(|answer| answer.sequence).collect::<Vec<_>>(), [1, 3, 5, 7, 9]);
    assert!(all.iter().all(|answer| answer.result.is_ok()), "{all:?}");
    assert_eq!(std::fs::read(folder.path().join("new")).expect("there"), b"hello");
    // The queue of one client is bounded, and another has room.
    bench.heard.clear();
    for number in 0..40 {
        bench.send(request(100 + 2 * number, CHECKSUM, 0, path.len() as u8, 0, path));
    }
    let refused = answers(&bench.heard);
    assert_eq!((later.waiting(), refused.len()), (32, 8));
    assert!(refused.iter().all(|answer| answer.result == Err(ERRNO)));
    receive_from(&mut bench, 2, request(500, CHECKSUM, 0, path.len() as u8, 0, path));
    assert_eq!(later.waiting(), 33);
    // A disk that never answers holds nothing else up.
    bench.fly(0.1);
    assert_eq!(bench.command(MavCmd::MAV_CMD_REQUEST_MESSAGE, [148.0; 7]), 0);
}

/// Rates that a client has asked for are those of the others again when it is gone.
#[test]
fn intervals_end_with_the_client_that_wanted_them() {
    const ATTITUDE: f32 = 30.0;
    let mut bench = paced();
    let set = |bench: &mut Bench, number, interval_us| {
        let parameters = [ATTITUDE, interval_us, 0.0, 0.0, 0.0, 0.0, 0.0];
        receive_from(bench, number, command_long(MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, parameters, 0));
    };
    let in_a_second = |bench: &mut Bench, gone: &[u64]| {
        bench.autopilot.transfer(0, |to| (!gone.contains(&to.number)).then_some(true));
        bench.heard.clear();
        bench.fly(1.0);
        let attitude = |message: &&Message| matches!(message, Message::Typed(MavMessage::ATTITUDE(_)));
        bench.heard.iter().filter(attitude).count()
    };
    let initial = in_a_second(&mut bench, &[]);
    set(&mut bench, 1, 20_000.0);
    set(&mut bench, 2, 5_000.0);
    set(&mut bench, 3, -1.0);
    let _settled = in_a_second(&mut bench, &[]);
    assert_eq!(in_a_second(&mut bench, &[]), 0);
    let near = |count: usize, expected: usize| count.abs_diff(expected) <= 1;
    assert!(near(in_a_second(&mut bench, &[3]), 200));
    assert!(near(in_a_second(&mut bench, &[2, 3]), 50));
    assert!(near(in_a_second(&mut bench, &[1, 2, 3]), initial));
}

/// No client makes a link carry more than others can read.
#[test]
fn a_link_carries_a_bounded_number_of_messages() {
    let mut bench = Bench::new(Identity::Px4);
    let results: Vec<u8> = [30.0, 31.0, 32.0, 33.0, 24.0, 105.0]
        .map(|id| bench.command(MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, [id, 1000.0, 0.0, 0.0, 0.0, 0.0, 0.0]))
        .to_vec();
    assert_eq!(results, [0, 0, 0, 2, 2, 2]);
    assert!(bench.texts().iter().any(|text| text.contains("at most 4000")), "{:?}", bench.texts());
    bench.heard.clear();
    bench.fly(1.0);
    assert!((3000..4001).contains(&bench.heard.len()), "{}", bench.heard.len());
}
