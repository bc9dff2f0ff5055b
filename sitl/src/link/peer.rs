//! A peer: its inbox, protocol version and systems.

use std::collections::BTreeMap;

use autopilot::codec::{Frame, Version};

use super::allowance::Allowance;
use super::inbox::Inbox;

/// Frames of MAVLink 1 in a row after which a peer is answered in it. Libraries that speak both begin with version 1
/// and change when they hear version 2.
const OLD_FRAMES: u8 = 3;
/// Systems behind one peer that are remembered.
const MOST_SEEN: usize = 64;

/// A peer.
#[derive(Clone, Debug, Default)]
pub struct Peer {
    /// What it has sent and nobody has looked at yet.
    pub inbox: Inbox,
    /// Whether it is gone, and only what it sent before is left to be looked at.
    pub departed: bool,
    /// Number of the next frame to it, from each component of each of our systems: each peer sees flows of its own.
    pub sequences: BTreeMap<(u8, u8), u8>,
    /// What it may be sent.
    pub allowance: Allowance,
    old_frames: u8,
    /// Systems and components behind it.
    seen: Vec<(u8, u8)>,
}

impl Peer {
    /// One that may be sent so much, with what of its has come already.
    pub fn new(allowance: Allowance, inbox: Inbox) -> Self {
        Self { allowance, inbox, ..Self::default() }
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
