//! Signing: pymavlink's signatures are ours, and what has come before, late, forged or unsigned is refused.

use autopilot::codec::{Frame, Message, Version};
use mavlink::dialects::ardupilotmega::{HEARTBEAT_DATA, MavMessage, RADIO_STATUS_DATA};
use proptest::prelude::*;
use sitl::signing::{Kept, Refusal, SecretKey, Signing, timestamp};

/// Some day of the year 2026.
const NOW: u64 = 37_000_000_000_000;
const MINUTE: u64 = 6_000_000;

fn bytes(hex: &str) -> Vec<u8> {
    (0..hex.len()).step_by(2).map(|at| u8::from_str_radix(&hex[at..at + 2], 16).expect("hex")).collect()
}

fn key(byte: u8) -> SecretKey {
    SecretKey::new([byte; 32]).expect("a key")
}

fn heartbeat(system: u8) -> Frame {
    let message = Message::from(MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()));
    Frame::encode(&message, Version::Two, 0, (system, 1)).expect("a message of MAVLink 2")
}

fn signed(with: &SecretKey, link: u8, system: u8, timestamp: u64) -> Frame {
    heartbeat(system).sign(link, timestamp, |bytes| with.tag(bytes))
}

fn guard() -> Signing {
    let mut signing = Signing::new(Some(key(1)), Kept::default());
    signing.set_clock(NOW);
    signing
}

/// Frames that pymavlink 2.4.50 has packed, without and with a signature: key, link, timestamp.
#[test]
fn signatures_are_pymavlinks() {
    let counting: [u8; 32] = core::array::from_fn(|index| index as u8 + 1);
    let vectors = [
        (
            counting,
            3,
            0x0123_4567_89ab,
            "fd09000007ffbe0000000000000006080000031f99",
            "fd09010007ffbe000000000000000608000003f86103ab8967452301b6bc2c76029c",
        ),
        (
            [0xaa; 32],
            0,
            42,
            "fd20000007ffbe4c00000000803f0000000000000000000000000000000000000000000000009001010105b2",
            "fd20010007ffbe4c00000000803f00000000000000000000000000000000000000000000000090010101d22c002a0000000000a99f752959d1",
        ),
    ];
    for (secret, link, timestamp, plain, with_signature) in vectors {
        let key = SecretKey::new(secret).expect("a key");
        let frame = Frame::parse(&bytes(plain)).expect("a frame");
        let frame = frame.sign(link, timestamp, |bytes| key.tag(bytes));
        assert_eq!(frame.bytes(), bytes(with_signature));
        let parsed = Frame::parse(&bytes(with_signature)).expect("a frame");
        assert_eq!(parsed, frame);
        let signature = parsed.signature().expect("it is signed");
        assert_eq!((signature.link, signature.timestamp), (link, timestamp));
        assert!(key.made(&signature.tag, parsed.covered_bytes()));
        let mut signing = Signing::new(Some(key), Kept::default());
        signing.set_clock(timestamp);
        assert_eq!(signing.verify(&parsed), Ok(()));
    }
}

#[test]
fn timestamps_count_from_2015() {
    assert_eq!(timestamp(1_420_070_400_000_000), 0);
    // 2026-01-01 00:00:00 UTC is 4018 days later.
    assert_eq!(timestamp(1_767_225_600_000_000), 4018 * 86_400 * 100_000);
    assert_eq!(timestamp(0), 0);
}

#[test]
fn what_is_wrong_is_refused_and_counted() {
    let mut signing = guard();
    assert_eq!(signing.verify(&signed(&key(1), 0, 255, NOW)), Ok(()));
    assert_eq!(signing.verify(&signed(&key(1), 0, 255, NOW)), Err(Refusal::Replayed));
    assert_eq!(signing.verify(&signed(&key(1), 0, 255, NOW - 1)), Err(Refusal::Replayed));
    assert_eq!(signing.verify(&signed(&key(2), 0, 255, NOW + 1)), Err(Refusal::Forged));
    assert_eq!(signing.verify(&heartbeat(255)), Err(Refusal::Unsigned));
    // Another link, system or component is another stream; it may begin a minute behind, and not more.
    assert_eq!(signing.verify(&signed(&key(1), 1, 255, NOW - MINUTE)), Ok(()));
    assert_eq!(signing.verify(&signed(&key(1), 0, 254, NOW - MINUTE - 1)), Err(Refusal::Late));
    let counts = signing.counts();
    assert_eq!((counts.replayed, counts.forged, counts.unsigned, counts.late), (2, 1, 1, 1));
    assert_eq!(counts.to_string(), "1 unsigned, 1 forged, 2 replayed, 1 late");
    // A radio has no key.
    let radio = Message::from(MavMessage::RADIO_STATUS(RADIO_STATUS_DATA::default()));
    for version in [Version::One, Version::Two] {
        let frame = Frame::encode(&radio, version, 0, (51, 68)).expect("a frame");
        assert_eq!(signing.verify(&frame), Ok(()));
    }
    // Without a key everything passes.
    assert_eq!(Signing::default().verify(&heartbeat(255)), Ok(()));
}

#[test]
fn a_forged_frame_cannot_poison_a_stream() {
    let mut signing = guard();
    let far = NOW + MINUTE;
    assert_eq!(signing.verify(&signed(&key(1), 0, 255, NOW)), Ok(()));
    assert_eq!(signing.verify(&signed(&key(2), 0, 255, far)), Err(Refusal::Forged));
    // Nor a right signature under another timestamp, link or flag.
    let right = signed(&key(1), 0, 255, NOW + 1);
    for (from_end, change) in [(13, 1), (12, 0xff), (7, 0x10), (6, 1), (1, 0x80)] {
        let mut bytes = right.bytes().to_vec();
        let at = bytes.len() - from_end;
        bytes[at] ^= change;
        let frame = Frame::parse(&bytes).expect("its checksum does not cover the signature");
        assert_eq!(signing.verify(&frame), Err(Refusal::Forged));
    }
    // Stream, other streams, and our own timestamps are where they were.
    assert_eq!(signing.verify(&right), Ok(()));
    assert_eq!(signing.verify(&signed(&key(1), 0, 7, NOW - MINUTE + 10)), Ok(()));
    assert!(signing.sign(heartbeat(1), 0).signature().expect("signed").timestamp < NOW + 10);
}

#[test]
fn our_timestamps_only_grow_even_across_a_crash_and_a_clock_that_goes_back() {
    let mut signing = guard();
    let mut last = 0;
    let mut kept = Kept::default();
    for _ in 0..300_000 {
        let signature = signing.sign(heartbeat(1), 2).signature().expect("signed");
        assert!(signature.timestamp > last && signature.link == 2);
        last = signature.timestamp;
        kept = signing.take_unkept().unwrap_or(kept);
    }
    let mut after_a_crash = Signing::new(Some(key(1)), kept.clone());
    after_a_crash.set_clock(NOW / 2);
    assert!(after_a_crash.sign(heartbeat(1), 0).signature().expect("signed").timestamp > last);
    let mut after_an_end = Signing::new(Some(key(1)), signing.at_end());
    assert_eq!(after_an_end.sign(heartbeat(1), 0).signature().expect("signed").timestamp, last + 1);
    assert!(kept.render().lines().count() == 3, "no stream but our own");
}

/// One clock that is wrong, by a day or by 80 years, moves neither ours nor the streams of those whose clocks are right.
#[test]
fn a_clock_ahead_locks_out_nobody_else() {
    let mut signing = guard();
    for ahead in [MINUTE + 1, 24 * 60 * MINUTE, (1 << 48) - 1 - NOW] {
        // The same stream as an honest client, and others.
        for system in [255, 254] {
            assert_eq!(signing.verify(&signed(&key(1), 0, system, NOW + ahead)), Err(Refusal::Early));
        }
    }
    assert_eq!(signing.counts().to_string(), "6 early");
    assert!(signing.sign(heartbeat(1), 0).signature().expect("signed").timestamp < NOW + 10);
    assert_eq!(signing.verify(&signed(&key(1), 0, 255, NOW)), Ok(()));
    // A minute ahead is accepted, and whoever has the right time still is.
    assert_eq!(signing.verify(&signed(&key(1), 0, 254, NOW + MINUTE)), Ok(()));
    assert_eq!(signing.verify(&signed(&key(1), 0, 253, NOW - MINUTE)), Ok(()));
    // Its own stream waits for a minute at most.
    assert_eq!(signing.verify(&signed(&key(1), 0, 254, NOW + 10)), Err(Refusal::Replayed));
    signing.set_clock(NOW + MINUTE + 1);
    assert_eq!(signing.verify(&signed(&key(1), 0, 254, NOW + MINUTE + 1)), Ok(()));
}

/// The machine's clock is corrected: what was sent before stays ahead, and clients that follow it are heard.
#[test]
fn a_clock_that_goes_back_locks_out_nobody() {
    let day = 24 * 60 * MINUTE;
    let mut signing = guard();
    signing.set_clock(NOW + day);
    let ours = signing.sign(heartbeat(1), 0).signature().expect("signed").timestamp;
    assert_eq!(signing.verify(&signed(&key(1), 0, 255, ours + 1)), Ok(()));
    let mut again = Signing::new(Some(key(1)), signing.at_end());
    again.set_clock(NOW);
    assert_eq!(again.verify(&signed(&key(1), 0, 254, NOW)), Ok(()), "with the right time");
    let ours = again.sign(heartbeat(1), 0).signature().expect("signed").timestamp;
    assert_eq!(again.verify(&signed(&key(1), 0, 255, ours + 1)), Ok(()), "with ours");
    assert_eq!(again.verify(&signed(&key(1), 0, 255, ours)), Err(Refusal::Replayed));
}

/// A holder of the key invents ten thousand streams; one that is in use stays, and one that begins later finds room.
#[test]
fn invented_streams_lock_out_nobody_and_nothing_comes_again() {
    let mut signing = guard();
    let client = |link, timestamp| signed(&key(1), link, 255, timestamp);
    for second in 0..5 {
        assert_eq!(signing.verify(&client(200, NOW + second)), Ok(()));
    }
    let invented =
        |number: u64| signed(&key(1), (number / 250) as u8, (number % 250) as u8, NOW + 10 + number);
    for number in 0..10_000 {
        assert_eq!(signing.verify(&invented(number)), Ok(()), "{number}");
    }
    // Its stream was not forgotten: an old frame is known as such, and the next one is accepted.
    assert_eq!(signing.verify(&client(200, NOW + 4)), Err(Refusal::Replayed));
    assert_eq!(signing.verify(&client(200, NOW + 5)), Ok(()));
    // Of all that was accepted nothing is accepted again, even after a restart.
    let kept = signing.at_end();
    assert_eq!(kept.streams.len(), 1024);
    let mut again = Signing::new(Some(key(1)), kept);
    for signing in [&mut signing, &mut again] {
        signing.set_clock(NOW);
        for number in 0..10_000 {
            assert!(signing.verify(&invented(number)).is_err(), "{number}");
        }
    }
    // Another client is let in as soon as its clock is past the frames that were forgotten.
    signing.set_clock(NOW + 20_000);
    assert_eq!(signing.verify(&client(201, NOW + 20_000)), Ok(()));
}

#[test]
fn streams_that_are_forgotten_cannot_come_again() {
    let mut signing = guard();
    let stream = |index: u64| ((index >> 8) as u8, index as u8);
    for index in 0..1024 {
        let (link, system) = stream(index);
        assert_eq!(signing.verify(&signed(&key(1), link, system, NOW)), Ok(()));
    }
    signing.set_clock(NOW + MINUTE + 1);
    assert_eq!(signing.verify(&signed(&key(1), 9, 9, NOW + MINUTE)), Ok(()));
    // Those that are too old have all made room at once.
    assert_eq!(signing.at_end().streams.len(), 1);
    for clock in [NOW + MINUTE + 1, NOW] {
        signing.set_clock(clock);
        for index in 0..1024 {
            let (link, system) = stream(index);
            assert_eq!(signing.verify(&signed(&key(1), link, system, NOW)), Err(Refusal::Late));
        }
    }
}

#[test]
fn another_key_is_another_secret_and_the_old_one_opens_nothing_old() {
    let mut signing = guard();
    assert_eq!(signing.verify(&signed(&key(1), 0, 255, NOW)), Ok(()));
    signing.set_key(Some(key(2)));
    assert_eq!(signing.verify(&signed(&key(1), 0, 255, NOW + 6)), Err(Refusal::Forged));
    assert_eq!(signing.verify(&signed(&key(2), 0, 255, NOW + 6)), Ok(()));
    signing.set_key(Some(key(1)));
    assert_eq!(signing.verify(&signed(&key(1), 0, 255, NOW)), Err(Refusal::Replayed));
    signing.set_key(None);
    assert_eq!(signing.verify(&heartbeat(255)), Ok(()));
    assert!(signing.sign(heartbeat(1), 0).signature().is_none());
}

proptest! {
    /// Whatever comes in whatever order, with crashes in between: no frame is accepted twice, each stream's accepted
    /// timestamps grow, and a stream that grows is accepted.
    #[test]
    fn nothing_is_accepted_twice(
        frames in prop::collection::vec((0u8..3, 1u8..4, 0u64..2 * MINUTE, 0u8..10), 1..200),
    ) {
        let key = key(1);
        let mut signing = guard();
        let mut on_disk = Kept::default();
        let mut latest = std::collections::BTreeMap::new();
        for (link, system, behind, fate) in frames {
            let timestamp = NOW + MINUTE - behind;
            let accepted = signing.verify(&signed(&key, link, system, timestamp)).is_ok();
            on_disk = signing.take_unkept().unwrap_or(on_disk);
            let last = latest.get(&(link, system)).copied();
            if accepted {
                prop_assert!(last.is_none_or(|last| timestamp > last));
                latest.insert((link, system), timestamp);
            } else if let Some(last) = last {
                // What is newer than all that may have been accepted before a crash is let in.
                prop_assert!(timestamp <= last + 100_000);
            } else {
                prop_assert!(timestamp + MINUTE < NOW + MINUTE);
            }
            if fate == 0 {
                signing = Signing::new(Some(key.clone()), on_disk.clone());
                signing.set_clock(NOW);
            }
        }
    }
}
