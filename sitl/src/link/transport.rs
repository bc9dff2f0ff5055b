//! Transports: they carry bytes to and from peers.

use std::time::Instant;

/// An event on a transport.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Event {
    /// A new peer.
    Opened(u64),
    /// Bytes from a peer, or a datagram from a sender that has no place yet.
    Bytes(u64, Vec<u8>),
    /// A peer has gone.
    Closed(u64),
}

/// Carries bytes to and from peers, which it numbers; never blocks.
pub trait Transport: std::fmt::Debug {
    /// Events since the last call. `room` says how many bytes of a peer there is room for: of a stream no more are read,
    /// so that its sender has to wait.
    fn poll(&mut self, now: Instant, room: &dyn Fn(u64) -> usize) -> Vec<Event>;

    /// A valid frame of a peer was accepted: it gets a place if it has none, and keeps it. Returns whether it has one.
    fn confirm(&mut self, _peer: u64, _now: Instant) -> bool {
        true
    }

    /// Whether somebody else may have sent in the name of a peer's address, to direct answers there.
    fn may_be_forged(&self, _peer: u64) -> bool {
        false
    }

    /// Sends a whole frame to a peer, at the next [`Transport::flush`] at the latest. If the peer's buffer is full, the frame is lost.
    fn send(&mut self, peer: u64, bytes: &[u8]);

    /// Sends somebody else's frame to a peer: it leaves room for our own.
    fn forward(&mut self, peer: u64, bytes: &[u8]) {
        self.send(peer, bytes);
    }

    /// Whether a peer has room for more than the telemetry.
    fn has_room(&self, _peer: u64) -> bool {
        true
    }

    /// Sends what is buffered.
    fn flush(&mut self);

    /// Whether frames are whole datagrams.
    fn is_datagram(&self) -> bool;

    /// Whether a peer is on this machine, or at the other end of a cable.
    fn is_local(&self, peer: u64) -> bool;

    /// The actual address, for people.
    fn description(&self) -> String;

    /// The actual address, as clients connect to it.
    fn address(&self) -> String;
}

/// Numbers that are never reused.
#[derive(Clone, Debug, Default)]
pub struct Numbers(u64);

impl Numbers {
    pub fn next(&mut self) -> u64 {
        self.0 += 1;
        self.0
    }
}

/// Whether an error only means that nothing is there yet.
pub fn is_nothing_yet(error: &std::io::Error) -> bool {
    matches!(error.kind(), std::io::ErrorKind::WouldBlock | std::io::ErrorKind::Interrupted)
}
