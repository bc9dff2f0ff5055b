//! What carries bytes.

use std::time::Instant;

/// What a transport has noticed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Event {
    /// A peer is there.
    Opened(u64),
    /// Bytes from a peer.
    Bytes(u64, Vec<u8>),
    /// A peer is gone.
    Closed(u64),
}

/// Carries bytes to and from peers, which it numbers; never waits.
pub trait Transport: std::fmt::Debug {
    /// What has happened since the last call.
    fn poll(&mut self, now: Instant) -> Vec<Event>;

    /// Sends a whole frame to a peer. A peer that cannot take it loses it.
    fn send(&mut self, peer: u64, bytes: &[u8]);

    /// Whether a peer takes more than the telemetry without losing it.
    fn has_room(&self, _peer: u64) -> bool {
        true
    }

    /// Sends what is waiting.
    fn flush(&mut self) {}

    /// Whether frames are whole datagrams.
    fn is_datagram(&self) -> bool;

    /// Whether a peer is on this machine, or at the other end of a cable.
    fn is_local(&self, peer: u64) -> bool;

    /// Where it really is, for a person.
    fn description(&self) -> String;

    /// Where it really is, as a client connects to it.
    fn address(&self) -> String;
}

/// Numbers that are never used again.
#[derive(Clone, Debug, Default)]
pub struct Numbers(u64);

impl Numbers {
    pub fn next(&mut self) -> u64 {
        self.0 += 1;
        self.0
    }
}

/// Whether an error only means "not now".
pub fn is_nothing_yet(error: &std::io::Error) -> bool {
    matches!(error.kind(), std::io::ErrorKind::WouldBlock | std::io::ErrorKind::Interrupted)
}
