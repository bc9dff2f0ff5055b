//! The download of logs: whole over a channel that loses, as fast as links take it, and erasing.

use crate::common::Bench;
use crate::common::channel::Lossy;
use crate::common::ftp_client::{Client, PROTECTED, REMOVE, noise};
use autopilot::codec::Message;
use autopilot::file_work::Immediate;
use mavlink::dialects::ardupilotmega::{
    LOG_DATA_DATA, LOG_ENTRY_DATA, LOG_ERASE_DATA, LOG_REQUEST_DATA_DATA, LOG_REQUEST_LIST_DATA, MavMessage,
};
use sitl::files::{Disk, LogFolder};
use tempfile::TempDir;
use vehicle::identity::Identity;

fn list_logs() -> MavMessage {
    let (target_system, target_component) = (1, 1);
    MavMessage::LOG_REQUEST_LIST(LOG_REQUEST_LIST_DATA {
        start: 0,
        end: u16::MAX,
        target_system,
        target_component,
    })
}

fn request_log(id: u16, ofs: u32, count: u32) -> MavMessage {
    let (target_system, target_component) = (1, 1);
    MavMessage::LOG_REQUEST_DATA(LOG_REQUEST_DATA_DATA { ofs, count, id, target_system, target_component })
}

fn entries(heard: Vec<Message>) -> Vec<LOG_ENTRY_DATA> {
    let entry = |message| match message {
        Message::Typed(MavMessage::LOG_ENTRY(entry)) => Some(entry),
        _ => None,
    };
    heard.into_iter().filter_map(entry).collect()
}

fn pieces(heard: Vec<Message>) -> Vec<LOG_DATA_DATA> {
    let piece = |message| match message {
        Message::Typed(MavMessage::LOG_DATA(piece)) => Some(piece),
        _ => None,
    };
    heard.into_iter().filter_map(piece).collect()
}

/// A folder with two logs of flights that are over, and one that is being written.
fn logs() -> (TempDir, LogFolder, Vec<Vec<u8>>) {
    let place = tempfile::tempdir().expect("a folder");
    let folder = LogFolder::open(place.path()).expect("a folder");
    let mut contents = Vec::new();
    for length in [20_007, 90, 50] {
        let (name, _) = folder.create(1, 10).expect("a log");
        contents.push(noise(length));
        std::fs::write(place.path().join(&name), &contents[contents.len() - 1]).expect("written");
        if length != 50 {
            folder.finish(&name);
        }
    }
    (place, folder, contents)
}

#[test]
fn logs_arrive_whole_over_a_lossy_channel() {
    for seed in 1..=4 {
        let (_place, folder, contents) = logs();
        let mut lossy = Lossy::new(seed);
        // Two pieces a millisecond.
        lossy.bench.turns = 2;
        lossy.bench.autopilot.share(Box::new(Immediate(Disk::open(Some(&folder), None).expect("a folder"))));
        // As clients do: ask again until all have come.
        let mut listed = std::collections::BTreeMap::new();
        while listed.len() < contents.len() {
            lossy.send(list_logs());
            for _ in 0..100 {
                listed.extend(
                    entries(lossy.step()).into_iter().map(|entry| (entry.id, (entry.size, entry.num_logs))),
                );
            }
            assert!(lossy.now_ms < 10_000, "seed {seed}: {listed:?}");
        }
        let sizes: Vec<usize> = listed.values().map(|(size, _)| *size as usize).collect();
        assert_eq!(sizes, [20_007, 90, 50]);
        assert!(listed.values().all(|(_, count)| *count == 3));

        for (id, content) in (0..).zip(&contents) {
            let mut got: Vec<Option<u8>> = vec![None; content.len()];
            let mut ask = (0, u32::MAX);
            while let Some(gap) = got.iter().position(Option::is_none) {
                lossy.send(request_log(id, ask.0, ask.1));
                let mut silent_ms = 0;
                while silent_ms < 150 {
                    let pieces = pieces(lossy.step());
                    silent_ms = if pieces.is_empty() { silent_ms + 1 } else { 0 };
                    for piece in pieces {
                        assert_eq!(piece.id, id);
                        let bytes = &piece.data[..usize::from(piece.count)];
                        for (place, byte) in got[piece.ofs as usize..].iter_mut().zip(bytes) {
                            *place = Some(*byte);
                        }
                    }
                }
                let gap = got.iter().position(Option::is_none).unwrap_or(gap);
                ask = (gap as u32, 90);
                assert!(lossy.now_ms < 120_000, "seed {seed}: stuck at {gap}");
            }
            assert!(got.into_iter().map(|byte| byte.expect("complete")).eq(content.iter().copied()));
        }
        assert!(lossy.down.lost > 0);
    }
}

/// PX4's ids count from zero, ArduPilot's from one: what QGroundControl and MAVProxy expect of each.
#[test]
fn ids_are_those_of_the_autopilot() {
    for (identity, first) in [(Identity::Px4, 0), (Identity::ArduPilot, 1)] {
        let (_place, folder, contents) = logs();
        let mut bench = Bench::new(identity);
        bench.autopilot.share(Box::new(Immediate(Disk::open(Some(&folder), None).expect("a folder"))));
        bench.send(list_logs());
        let listed = entries(std::mem::take(&mut bench.heard));
        let ids: Vec<u16> = listed.iter().map(|entry| entry.id).collect();
        assert_eq!(ids, [first, first + 1, first + 2]);
        assert!(listed.iter().all(|entry| (entry.num_logs, entry.last_log_num) == (3, first + 2)));
        let mut piece = |id| {
            bench.heard.clear();
            bench.send(request_log(id, 0, 90));
            pieces(std::mem::take(&mut bench.heard)).remove(0)
        };
        assert_eq!(piece(first).data, contents[0][..90]);
        assert_eq!(piece(first + 1).data, contents[1][..90]);
        assert_eq!(piece(first + 3).count, 0);
        if let Some(below) = first.checked_sub(1) {
            assert_eq!(piece(below).count, 0);
        }
    }
}

#[test]
fn a_download_waits_for_room_and_ends_when_told() {
    let (place, folder, contents) = logs();
    let mut bench = Bench::new(Identity::Px4);
    bench.turns = 0;
    bench.autopilot.share(Box::new(Immediate(Disk::open(Some(&folder), None).expect("a folder"))));
    let sent = |bench: &mut Bench, most: usize, room: Option<bool>| {
        bench.heard.clear();
        bench.autopilot.transfer(most, |_| room);
        bench.listen();
        pieces(std::mem::take(&mut bench.heard))
    };
    bench.send(request_log(0, 0, u32::MAX));
    assert!(sent(&mut bench, 10, Some(false)).is_empty());
    let first = sent(&mut bench, 3, Some(true));
    assert_eq!(first.iter().map(|piece| piece.ofs).collect::<Vec<_>>(), [0, 90, 180]);
    assert_eq!(first[1].data, contents[0][90..180]);
    let end =
        mavlink::dialects::ardupilotmega::LOG_REQUEST_END_DATA { target_system: 1, target_component: 1 };
    bench.send(MavMessage::LOG_REQUEST_END(end));
    assert!(sent(&mut bench, 10, Some(true)).is_empty());
    // The end of a file of whole pieces is an empty one, and so is what is not there.
    bench.send(request_log(1, 0, u32::MAX));
    assert_eq!(sent(&mut bench, 10, Some(true)).iter().map(|piece| piece.count).collect::<Vec<_>>(), [90, 0]);
    bench.send(request_log(77, 0, 90));
    assert_eq!(sent(&mut bench, 10, Some(true)).iter().map(|piece| piece.count).collect::<Vec<_>>(), [0]);
    // Who is gone gets nothing more, not even when it comes back.
    bench.send(request_log(0, 0, u32::MAX));
    assert!(sent(&mut bench, 10, None).is_empty());
    assert!(sent(&mut bench, 10, Some(true)).is_empty());
    // FTP reads them, too, and removes none.
    bench.turns = 10_000;
    let mut client = Client { bench, sequence: 0 };
    assert_eq!(client.list("/logs").expect("a list").len(), 3);
    assert_eq!(client.read("/logs/flight_00002_id1.ulg"), Ok(contents[1].clone()));
    assert_eq!(client.on(REMOVE, "/logs/flight_00002_id1.ulg"), Err(PROTECTED));
    // Erasing leaves the log that is being written, and what is no log.
    std::fs::write(place.path().join("notes.txt"), "mine").expect("written");
    client.bench.send(MavMessage::LOG_ERASE(LOG_ERASE_DATA { target_system: 1, target_component: 1 }));
    assert!(client.bench.texts().iter().any(|text| text == "Logs erased by 255/190"));
    let left = client.list("/logs").expect("a list");
    assert_eq!(left, ["Fflight_00003_id1.ulg\t50", "Fnotes.txt\t4"].map(str::to_owned).to_vec());
}
