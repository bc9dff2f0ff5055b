//! A peer: its stream of frames, protocol version and systems.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use autopilot::codec::{Frame, FrameDecoder, Version};

use super::allowance::Allowance;

/// Frames of MAVLink 1 in a row after which a peer is answered in it. Libraries that speak both begin with version 1
/// and change when they hear version 2.
const OLD_FRAMES: u8 = 3;
/// Systems behind one peer that are remembered.
const MOST_SEEN: usize = 64;

/// An incomplete frame is given up after this long a silence: the longest one takes 50 ms on a slow serial line.
const SILENCE: Duration = Duration::from_millis(200);

/// A peer.
#[derive(Clone, Debug, Default)]
pub struct Peer {
    /// Its stream of bytes.
    decoder: FrameDecoder,
    last_bytes: Option<Instant>,
    /// Number of the next frame to it, from each of our systems: each peer sees flows of its own.
    pub sequences: BTreeMap<u8, u8>,
    /// What it may be sent.
    pub allowance: Allowance,
    old_frames: u8,
    /// Systems and components behind it.
    seen: Vec<(u8, u8)>,
}

impl Peer {
    /// One that may be sent so much.
    pub fn new(allowance: Allowance) -> Self {
        Self { allowance, ..Self::default() }
    }

    /// Frames that received bytes complete.
    pub fn frames(&mut self, bytes: &[u8], datagram: bool, now: Instant) -> Vec<Frame> {
        self.last_bytes = Some(now);
        if datagram { self.decoder.datagram(bytes) } else { self.decoder.push(bytes) }
    }

    /// Frames after the start of a frame that never ended.
    pub fn overdue(&mut self, now: Instant) -> Vec<Frame> {
        let silent = self.last_bytes.is_some_and(|last| now.saturating_duration_since(last) > SILENCE);
        if silent && self.decoder.waiting_bytes() > 0 { self.decoder.give_up() } else { Vec::new() }
    }

    /// Learns version and sender from a frame.
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

    /// The protocol version to send.
    pub fn version(&self) -> Version {
        if self.old_frames >= OLD_FRAMES { Version::One } else { Version::Two }
    }

    /// Whether a system has sent through this peer; zero means any.
    pub fn leads_to(&self, system: u8) -> bool {
        system == 0 || self.seen.iter().any(|(seen, _)| *seen == system)
    }

    /// Whether anything was received from it.
    pub fn has_spoken(&self) -> bool {
        !self.seen.is_empty()
    }
}
