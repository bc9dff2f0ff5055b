//! Where messages come from and go to.

use serde::{Deserialize, Serialize};

use crate::codec::Message;

/// A peer of a link.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct PeerId {
    /// Number of the link.
    pub link: usize,
    /// Number of the peer, never used again.
    pub number: u64,
}

/// Who sent a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Origin {
    /// By which way it came.
    pub peer: PeerId,
    /// System.
    pub system: u8,
    /// Component.
    pub component: u8,
}

/// Who a message goes to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Destination {
    /// Every peer of every link.
    Everyone,
    /// Every peer of a link.
    Link(usize),
    /// One peer.
    Peer(PeerId),
}

/// A message on its way out.
#[derive(Clone, Debug, PartialEq)]
pub struct Outgoing {
    /// Where to.
    pub to: Destination,
    /// What.
    pub message: Message,
    /// Which component of the vehicle says it.
    pub component: u8,
}

/// What a link is for: it decides the rates of its messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LinkProfile {
    /// A ground station.
    #[default]
    Ground,
    /// A program beside the autopilot, with faster telemetry.
    Onboard,
}
