//! Signed frames that somebody without the key has changed, heard before, or made.

use autopilot::codec::{Frame, FrameDecoder, Message, Version};
use mavlink::dialects::ardupilotmega::{HEARTBEAT_DATA, MavMessage};
use sitl::signing::{Kept, SecretKey, Signing};

use super::bytes::Bytes;

/// Some day of the year 2026.
const NOW: u64 = 37_000_000_000_000;
/// Frames of the owner in one case.
const FRAMES: usize = 100;
/// Frames of the attacker between two of them.
const ATTACKS: usize = 20;

fn key(byte: u8) -> SecretKey {
    SecretKey::new([byte; 32]).expect("a key")
}

/// Plays an owner of the key and an attacker who hears everything. Panics if one frame of the attacker is accepted, one of
/// the owner is not, or the attacker makes the memory grow. Returns the number of frames refused.
pub fn forged(seed: u64) -> u64 {
    let mut bytes = Bytes::new(seed);
    let mut guard = Signing::new(Some(key(1)), Kept::default());
    let [mut owner, mut stranger] = [1, 2].map(|byte| Signing::new(Some(key(byte)), Kept::default()));
    for signing in [&mut guard, &mut owner, &mut stranger] {
        signing.set_clock(NOW);
    }
    let heartbeat = Message::from(MavMessage::HEARTBEAT(HEARTBEAT_DATA::default()));
    let mut heard: Vec<Frame> = Vec::new();
    let mut refused = 0;
    for number in 0..FRAMES {
        let frame = Frame::encode(&heartbeat, Version::Two, number as u8, (255, 190)).expect("a frame");
        let frame = owner.sign(frame, bytes.below(3) as u8);
        let before = guard.take_unkept();
        for _ in 0..ATTACKS {
            for attack in attacks(&mut bytes, &heard, &frame, &mut stranger) {
                assert!(guard.verify(&attack).is_err(), "accepted: {attack:?}");
                refused += 1;
            }
        }
        assert_eq!(guard.take_unkept(), None, "an attack changed what is kept: {before:?}");
        assert_eq!(guard.verify(&frame), Ok(()), "a frame of the owner");
        heard.push(frame);
    }
    refused
}

/// What an attacker can make of what was heard and of what is on its way.
fn attacks(bytes: &mut Bytes, heard: &[Frame], next: &Frame, stranger: &mut Signing) -> Vec<Frame> {
    match bytes.below(4) {
        // Heard before.
        0 if !heard.is_empty() => vec![heard[bytes.below(heard.len())].clone()],
        // Under a key of its own.
        1 => FrameDecoder::default()
            .datagram(&bytes.real())
            .into_iter()
            .filter(|frame| frame.version() == Version::Two)
            .map(|frame| stranger.sign(frame, 0))
            .collect(),
        // Changed on its way: content with a checksum that fits, signature, or both.
        2 => {
            let mut changed = next.bytes().to_vec();
            for _ in 0..=bytes.below(3) {
                let at = bytes.below(changed.len());
                changed[at] ^= 1 << bytes.below(8);
            }
            let end = changed.len() - 13;
            if changed.len() == next.bytes().len() {
                let checksum = mavlink::calculate_crc(&changed[1..end - 2], heartbeat_extra());
                changed[end - 2..end].copy_from_slice(&checksum.to_le_bytes());
            }
            Frame::parse(&changed).filter(|frame| frame != next).into_iter().collect()
        }
        // Unsigned, or anything.
        _ => FrameDecoder::default()
            .datagram(&bytes.piece())
            .into_iter()
            .filter(|frame| frame.message_id() != RADIO_STATUS)
            .collect(),
    }
}

/// It may come unsigned: a radio has no key.
const RADIO_STATUS: u32 = 109;

fn heartbeat_extra() -> u8 {
    <MavMessage as mavlink::Message>::extra_crc(0)
}
