//! Links whose ends are lists.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use mavlink::dialects::ardupilotmega::{
    ATTITUDE_DATA, HEARTBEAT_DATA, MavMessage, RADIO_STATUS_DATA, SETUP_SIGNING_DATA, SYSTEM_TIME_DATA,
};

use super::{Link, Links, Lost, Peer, Received};
use crate::link::inbox::Inbox;
use crate::link::transport::{Event, Transport};
use crate::link::{SetupRefusal, SetupRules, SigningSetup};
use crate::signing::{SecretKey, Signing};
use autopilot::codec::{COMPONENT, Frame, Message, Version};
use autopilot::envelope::{Destination, Outgoing, PeerId};

/// What the clock shows.
const NOW: u64 = 50;

type Bytes = Arc<Mutex<Vec<Vec<u8>>>>;

/// A link whose two ends are lists. An empty piece ends the peer's connection.
#[derive(Debug)]
struct Ends {
    inward: Bytes,
    outward: Bytes,
    local: bool,
    /// Whether it has no place for peers.
    full: bool,
}

impl Transport for Ends {
    fn poll(&mut self, _now: Instant, _room: &dyn Fn(u64) -> usize) -> Vec<Event> {
        let mut waiting = self.inward.lock().expect("one thread");
        let event = |bytes: Vec<u8>| if bytes.is_empty() { Event::Closed(1) } else { Event::Bytes(1, bytes) };
        waiting.drain(..).map(event).collect()
    }

    fn send(&mut self, _peer: u64, bytes: &[u8]) {
        self.outward.lock().expect("one thread").push(bytes.to_vec());
    }

    fn flush(&mut self) {}

    fn is_datagram(&self) -> bool {
        true
    }

    fn confirm(&mut self, _peer: u64, _now: Instant) -> bool {
        !self.full
    }

    fn may_be_forged(&self, _peer: u64) -> bool {
        !self.local
    }

    fn is_local(&self, _peer: u64) -> bool {
        self.local
    }

    fn description(&self) -> String {
        String::new()
    }

    fn address(&self) -> String {
        String::new()
    }
}

/// A vehicle with one link to this machine and one from afar, and their ends.
fn links() -> (Links, [(Bytes, Bytes); 2]) {
    let ends: [(Bytes, Bytes); 2] = Default::default();
    let of = |(inward, outward): &(Bytes, Bytes), local| Link {
        transport: Box::new(Ends { inward: inward.clone(), outward: outward.clone(), local, full: false }),
        peers: BTreeMap::new(),
        strangers: Inbox::default(),
    };
    let mut links = Links::of(vec![of(&ends[0], true), of(&ends[1], false)], vec![1]);
    links.setup_rules = SetupRules { without_key: true, armed: false };
    links.signing.set_clock(NOW);
    (links, ends)
}

/// All frames that have come and are accepted.
fn receive(links: &mut Links) -> Vec<Received> {
    receive_at(links, Instant::now())
}

fn receive_at(links: &mut Links, now: Instant) -> Vec<Received> {
    links.poll(now);
    std::iter::from_fn(|| links.take_turn(now, |_| true)).filter_map(|turn| turn.received).collect()
}

fn frame(message: MavMessage, system: u8) -> Frame {
    Frame::encode(&message.into(), Version::Two, 0, (system, 190)).expect("a message of MAVLink 2")
}

fn everyone(message: Message) -> Outgoing {
    Outgoing { to: Destination::Everyone, message, component: COMPONENT }
}

fn heartbeat(system: u8) -> Frame {
    frame(MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()), system)
}

fn setup(key: u8, target_system: u8) -> Frame {
    let setup = SETUP_SIGNING_DATA {
        initial_timestamp: NOW,
        target_system,
        target_component: 1,
        secret_key: [key; 32],
    };
    frame(MavMessage::SETUP_SIGNING(setup), 255)
}

#[test]
fn a_key_comes_from_this_machine_only_and_goes_nowhere() {
    let (mut links, [near, far]) = links();
    let mut receive = |end: &(Bytes, Bytes), frame: &Frame| {
        end.0.lock().expect("one thread").push(frame.bytes().to_vec());
        let received = receive(&mut links);
        (received.len(), links.take_setups(), links.signing().is_on())
    };
    // Both ends have spoken: what one sends is forwarded to the other.
    assert_eq!(receive(&near, &heartbeat(255)).0, 1);
    assert_eq!(receive(&far, &heartbeat(254)).0, 1);
    let forwarded = near.1.lock().expect("one thread").len();
    assert_eq!(forwarded, 1);

    assert_eq!(
        receive(&far, &setup(7, 1)),
        (0, vec![SigningSetup::Refused(255, 190, SetupRefusal::NotLocal)], false)
    );
    // For another vehicle it is not passed on, either.
    assert_eq!(receive(&near, &setup(7, 2)), (0, vec![], false));
    assert_eq!(receive(&near, &setup(7, 1)), (0, vec![SigningSetup::Set(255, 190)], true));
    assert_eq!(far.1.lock().expect("one thread").len(), 0, "the key was passed on");
    assert_eq!(near.1.lock().expect("one thread").len(), forwarded, "the key was passed on");

    // From now on a key can only be changed by who knows it.
    assert_eq!(receive(&near, &setup(0, 1)), (0, vec![], true));
    let key = SecretKey::new([7; 32]).expect("a key");
    let removal = setup(0, 1).sign(0, 60, |bytes| key.tag(bytes));
    assert_eq!(receive(&near, &removal), (0, vec![SigningSetup::Removed(255, 190)], false));
    assert!(!format!("{links:?}").contains("7, 7, 7, 7"), "the key is remembered in the open");
}

/// Bytes that have left by one end since the last call.
fn drawn(end: &(Bytes, Bytes)) -> usize {
    end.1.lock().expect("one thread").drain(..).map(|bytes| bytes.len()).sum()
}

/// What is told to everyone, a thousand times: telemetry and heartbeats.
fn tell(links: &mut Links) {
    let heartbeat = Message::from(MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()));
    let attitude = Message::from(MavMessage::ATTITUDE(ATTITUDE_DATA::default()));
    for message in [heartbeat, attitude] {
        for _ in 0..1000 {
            links.send(&everyone(message.clone()), 1);
        }
    }
}

#[test]
fn a_stranger_gets_nothing_and_an_address_from_afar_ten_times_what_it_sent() {
    let (mut links, [near, far]) = links();
    let start = Instant::now();
    let put = |end: &(Bytes, Bytes), bytes: &[u8]| end.0.lock().expect("one thread").push(bytes.to_vec());
    for end in [&near, &far] {
        put(end, &[0xfd]);
        put(end, &heartbeat(9).bytes()[..20]);
    }
    assert!(receive_at(&mut links, start).is_empty());
    tell(&mut links);
    assert_eq!((drawn(&near), drawn(&far), links.active_peers()), (0, 0, 0));
    // A frame makes a peer: on this machine without a limit.
    let frame = heartbeat(9);
    put(&near, frame.bytes());
    assert_eq!(receive_at(&mut links, start).len(), 1);
    tell(&mut links);
    assert!(drawn(&near) > 30_000);
    let frame = heartbeat(10);
    put(&far, frame.bytes());
    assert_eq!(receive_at(&mut links, start).len(), 1);
    drawn(&near);
    // Forwarded frames count as telemetry.
    put(&near, heartbeat(9).bytes());
    receive_at(&mut links, start);
    assert_eq!(drawn(&far), 0);
    tell(&mut links);
    let most = 10 * frame.bytes().len();
    assert!((most - 21..=most).contains(&drawn(&far)));
    // Whoever keeps talking gets everything, forwarded frames, too.
    for second in 1..=3 {
        put(&far, frame.bytes());
        receive_at(&mut links, start + Duration::from_secs(second));
    }
    put(&near, heartbeat(8).bytes());
    receive_at(&mut links, start + Duration::from_secs(3));
    assert_eq!(drawn(&far), heartbeat(8).bytes().len());
    tell(&mut links);
    assert!(drawn(&far) > 30_000);
    receive_at(&mut links, start + Duration::from_secs(9));
    tell(&mut links);
    assert_eq!(drawn(&far), 0);
}

#[test]
fn who_has_no_place_has_no_effect() {
    let (mut links, [near, _]) = links();
    links.links[0].transport =
        Box::new(Ends { inward: near.0.clone(), outward: near.1.clone(), local: true, full: true });
    near.0.lock().expect("one thread").push(heartbeat(9).bytes().to_vec());
    assert!(receive_at(&mut links, Instant::now()).is_empty(), "nobody could be answered");
    assert_eq!(links.active_peers(), 0);
}

/// A connection that is refused ends at the next look. What it had sent must not be taken for the rest of a peer's.
#[test]
fn what_a_refused_connection_has_sent_has_no_effect_after_its_end() {
    let (mut links, [near, _]) = connected();
    links.links[0].transport =
        Box::new(Ends { inward: near.0.clone(), outward: near.1.clone(), local: true, full: true });
    put(&near, &[heartbeat(255).bytes(), heartbeat(254).bytes()].concat());
    let now = Instant::now();
    links.poll(now);
    let turn = links.take_turn(now, |_| true).expect("bytes wait");
    assert!(turn.received.is_none(), "refused");
    put(&near, &[]);
    assert!(receive_at(&mut links, now).is_empty(), "nobody could be answered");
    assert!(links.links[0].peers.is_empty());
}

#[test]
fn nothing_is_forwarded_to_who_has_left() {
    let (mut links, [flood, left]) = connected();
    put(&left, heartbeat(255).bytes());
    assert_eq!(receive(&mut links).len(), 1);
    // It is gone, and something of it waits.
    put(&left, heartbeat(255).bytes());
    put(&left, &[]);
    put(&flood, &different(254, 2_000));
    let now = Instant::now();
    links.poll(now);
    let turns = std::iter::from_fn(|| links.take_turn(now, |peer| peer.link == 0));
    assert_eq!(turns.filter(|turn| turn.received.is_some()).count(), 2_000);
    assert_eq!(links.lost(), Lost::default(), "nobody was there to lose a frame");
}

/// With a key a radio may speak without one, but does not become a peer by that.
#[test]
fn with_a_key_only_signed_frames_make_peers() {
    let (mut links, [near, _]) = links();
    let key = SecretKey::new([7; 32]).expect("a key");
    let mut signing = Signing::new(Some(key.clone()), Default::default());
    signing.set_clock(NOW);
    links.sign_with(signing);
    let mut receive = |frame: Frame| {
        near.0.lock().expect("one thread").push(frame.bytes().to_vec());
        let received = receive_at(&mut links, Instant::now()).len();
        (received, links.active_peers())
    };
    let radio = || frame(MavMessage::RADIO_STATUS(RADIO_STATUS_DATA::default()), 51);
    assert_eq!(receive(radio()), (0, 0));
    assert_eq!(receive(heartbeat(255)), (0, 0));
    assert_eq!(receive(heartbeat(255).sign(0, NOW, |bytes| key.tag(bytes))), (1, 1));
    assert_eq!(receive(radio()), (1, 1));
}

#[test]
fn what_is_refused_reaches_nobody_and_teaches_nothing() {
    let (mut links, [near, far]) = links();
    let key = SecretKey::new([7; 32]).expect("a key");
    links.sign_with(Signing::new(Some(key.clone()), Default::default()));
    let put = |end: &(Bytes, Bytes), frame: &Frame| {
        end.0.lock().expect("one thread").push(frame.bytes().to_vec());
    };
    let sign = |frame: Frame, timestamp| frame.sign(0, timestamp, |bytes| key.tag(bytes));
    put(&near, &sign(heartbeat(255), 9));
    put(&far, &heartbeat(254));
    assert_eq!(receive(&mut links).len(), 1);
    assert_eq!(links.active_peers(), 1);
    put(&near, &sign(heartbeat(255), 10));
    assert_eq!(receive(&mut links).len(), 1);
    assert!(far.1.lock().expect("one thread").is_empty(), "who was refused is not forwarded to");
    put(&far, &sign(heartbeat(254), 11));
    put(&far, &sign(heartbeat(254), 11));
    assert_eq!(receive(&mut links).len(), 1);
    assert_eq!(near.1.lock().expect("one thread").len(), 1, "forwarded once, as it came");
    assert_eq!(links.signing().counts().to_string(), "1 unsigned, 1 replayed");

    // Ours: signed, each link under its number, never in MAVLink 1.
    near.1.lock().expect("one thread").clear();
    let message = Message::from(MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()));
    links.send(&everyone(message), 1);
    let sent = [near, far].map(|end| {
        let frame = Frame::parse(end.1.lock().expect("one thread").last().expect("sent")).expect("a frame");
        frame.signature().expect("signed")
    });
    assert_eq!(sent.map(|signature| signature.link), [0, 1]);
    assert!(sent[0].timestamp < sent[1].timestamp);
}

/// The same with a connected peer on each link.
fn connected() -> (Links, [(Bytes, Bytes); 2]) {
    let (mut links, ends) = links();
    links.links.iter_mut().for_each(|link| drop(link.peers.insert(1, Peer::default())));
    (links, ends)
}

fn put(end: &(Bytes, Bytes), bytes: &[u8]) {
    end.0.lock().expect("one thread").push(bytes.to_vec());
}

/// Number of the link of the next frames, each of which costs as much as a redesign.
fn served(links: &mut Links, turns: usize) -> Vec<usize> {
    let now = Instant::now();
    let served = (0..turns).filter_map(|_| {
        let turn = links.take_turn(now, |_| true)?;
        links.charge(turn.peer, Duration::from_micros(1_500), turn.received.is_some());
        turn.received.map(|received| received.origin.peer.link)
    });
    served.collect()
}

/// Frames from a system that are no repetitions of one another.
fn different(system: u8, count: u64) -> Vec<u8> {
    let message = |time_unix_usec| SYSTEM_TIME_DATA { time_unix_usec, time_boot_ms: 0 };
    (0..count).flat_map(|n| frame(MavMessage::SYSTEM_TIME(message(n)), system).bytes().to_vec()).collect()
}

#[test]
fn a_message_does_not_wait_behind_those_of_another_peer() {
    let (mut links, [flood, quiet]) = connected();
    put(&flood, &different(254, 1_000));
    links.poll(Instant::now());
    assert_eq!(served(&mut links, 3), [0; 3]);
    put(&quiet, heartbeat(255).bytes());
    links.poll(Instant::now());
    assert_eq!(served(&mut links, 2), [1, 0]);
    // Both want more than they get: they get the same.
    put(&quiet, &different(255, 1_000));
    links.poll(Instant::now());
    let served = served(&mut links, 100);
    let share = served.iter().filter(|link| **link == 1).count();
    assert!((49..=51).contains(&share), "{share} of {}", served.len());
    // A peer that may not have a turn now keeps what it has, and no one waits for it.
    let turn = links.take_turn(Instant::now(), |peer| peer.link == 1).expect("more waits");
    assert_eq!(turn.peer.link, 1);
}

#[test]
fn an_inbox_is_bounded_and_what_is_lost_is_counted() {
    let (mut links, [flood, quiet]) = links();
    (0..9).for_each(|_| put(&flood, &different(254, 4_000)));
    put(&quiet, heartbeat(255).bytes());
    links.poll(Instant::now());
    assert_eq!(links.lost(), Lost { datagrams: 7, forwards: 0 });
    assert_eq!(links.lost().to_string(), "dropped 7 datagrams");
    assert_eq!(Lost { datagrams: 1, forwards: 2 }.to_string(), "dropped 1 datagram, 2 forwarded frames");
    let handled = receive(&mut links);
    assert_eq!(handled.iter().filter(|received| received.origin.peer.link == 0).count(), 8_000);
    assert!(handled.iter().any(|received| received.origin.peer.link == 1));
}

#[test]
fn what_a_flood_has_forwarded_is_bounded() {
    let (mut links, [flood, quiet]) = connected();
    put(&quiet, heartbeat(255).bytes());
    assert_eq!(receive(&mut links).len(), 1);
    put(&flood, &different(254, 2_000));
    // The vehicle itself hears all.
    assert_eq!(receive(&mut links).len(), 2_000);
    let forwarded = quiet.1.lock().expect("one thread").len() as u64;
    assert_eq!(links.lost(), Lost { datagrams: 0, forwards: 2_000 - forwarded });
    assert!((100..1_000).contains(&forwarded), "{forwarded}");
}

#[test]
fn what_a_peer_has_sent_before_it_left_is_still_handled() {
    let (mut links, [end, _]) = connected();
    put(&end, &[heartbeat(255).bytes(), heartbeat(254).bytes()].concat());
    put(&end, &[]);
    links.poll(Instant::now());
    let peer = PeerId { link: 0, number: 1 };
    assert_eq!((links.has_room(peer), links.active_peers()), (None, 0), "it has left");
    assert_eq!(receive(&mut links).len(), 2);
    assert!(links.links[0].peers.is_empty(), "and is forgotten");
    // Those who come, say something and go are bounded, too.
    let now = Instant::now();
    let link = &mut links.links[0];
    for number in 0..100 {
        link.peers.entry(number).or_default().inbox.put(vec![0], number, true, 0, now);
        link.depart(number, now);
    }
    assert_eq!(link.peers.len(), super::MOST_DEPARTED);
}
