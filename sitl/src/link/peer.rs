//! What is known of a peer.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use autopilot::codec::{Frame, FrameDecoder, Version};

/// Frames of MAVLink 1 in a row after which a peer is answered in it. Libraries that speak both begin with version 1
/// and change when they hear version 2.
const OLD_FRAMES: u8 = 3;
/// Systems behind one peer that are remembered.
const MOST_SEEN: usize = 64;

/// A frame that is not complete after so long a silence is none: the longest one takes 50 ms on a slow serial line.
const SILENCE: Duration = Duration::from_millis(200);

/// A peer.
#[derive(Clone, Debug, Default)]
pub struct Peer {
    /// Its stream of bytes.
    decoder: FrameDecoder,
    last_bytes: Option<Instant>,
    /// Number of the next frame to it, from each of our systems: each peer sees flows of its own.
    pub sequences: BTreeMap<u8, u8>,
    old_frames: u8,
    /// Systems and components behind it.
    seen: Vec<(u8, u8)>,
}

impl Peer {
    /// Frames that bytes from it complete.
    pub fn frames(&mut self, bytes: &[u8], datagram: bool, now: Instant) -> Vec<Frame> {
        self.last_bytes = Some(now);
        if datagram { self.decoder.datagram(bytes) } else { self.decoder.push(bytes) }
    }

    /// Frames behind something that has begun like a frame and never ended.
    pub fn overdue(&mut self, now: Instant) -> Vec<Frame> {
        let silent = self.last_bytes.is_some_and(|last| now.saturating_duration_since(last) > SILENCE);
        if silent && self.decoder.waiting_bytes() > 0 { self.decoder.give_up() } else { Vec::new() }
    }

    /// Learns from a frame of it.
    pub fn learn(&mut self, frame: &Frame) {
        self.old_frames = match frame.version() {
            Version::One => self.old_frames.saturating_add(1),
            Version::Two => 0,
        };
        let sender = (frame.system(), frame.component());
        if !self.seen.contains(&sender) && self.seen.len() < MOST_SEEN {
            self.seen.push(sender);
        }
    }

    /// The version to speak to it.
    pub fn version(&self) -> Version {
        if self.old_frames >= OLD_FRAMES { Version::One } else { Version::Two }
    }

    /// Whether a system is behind it; zero is any.
    pub fn leads_to(&self, system: u8) -> bool {
        system == 0 || self.seen.iter().any(|(seen, _)| *seen == system)
    }

    /// Whether anything has come from it.
    pub fn has_spoken(&self) -> bool {
        !self.seen.is_empty()
    }
}
