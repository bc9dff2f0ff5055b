//! What a page beside the links hears of the vehicles, and asks of them in their pilot's place.

use std::time::Instant;

use autopilot::codec::{Frame, Message, Version, id};
use autopilot::envelope::{Destination, Origin, Outgoing, PeerId};
use mavlink::dialects::ardupilotmega::MavMessage;

use super::Fleet;
use crate::link::Received;

/// Whom requests come from: a ground station that is behind no link.
const PAGE: Origin = Origin { peer: PeerId { link: 0, number: u64::MAX - 1 }, system: 255, component: 190 };
/// Messages that wait to be looked at.
const MOST_WAITING: usize = 256;

/// A message that the page is interested in.
#[derive(Clone, Debug)]
pub struct Overheard {
    /// System id of who says it.
    pub system: u8,
    /// Simulation time, µs.
    pub time_us: u64,
    /// What.
    pub message: Message,
}

/// Ears beside the links; deaf until somebody listens.
#[derive(Debug, Default)]
pub struct Onlooker {
    listens: bool,
    heard: Vec<Overheard>,
    sequence: u8,
}

impl Onlooker {
    /// Takes in what a vehicle sends, if it is a line for the pilot or an answer to the page. Lines are those to everyone: the
    /// vehicle introduces itself again to each peer that comes later, but the page has heard it from the start.
    pub(super) fn hear(&mut self, system: u8, time_us: u64, outgoing: &Outgoing) {
        let is_line = outgoing.message.id() == id::STATUSTEXT;
        let is_ours = match outgoing.to {
            Destination::Everyone => is_line,
            Destination::Peer(peer) => peer == PAGE.peer && !is_line,
            Destination::Link(_) => false,
        };
        if self.listens && is_ours && self.heard.len() < MOST_WAITING {
            self.heard.push(Overheard { system, time_us, message: outgoing.message.clone() });
        }
    }
}

impl Fleet {
    /// From now on the page hears the vehicles.
    pub(crate) fn listen(&mut self) {
        self.onlooker.listens = true;
    }

    /// What the page has heard since the last call.
    pub(crate) fn take_overheard(&mut self) -> Vec<Overheard> {
        std::mem::take(&mut self.onlooker.heard)
    }

    /// A message of the page takes effect on a vehicle as a ground station's does: it is recorded, and replays have it.
    pub(crate) fn ask(&mut self, number: usize, message: MavMessage, now: Instant) {
        self.books.keep_size(&self.members);
        self.onlooker.sequence = self.onlooker.sequence.wrapping_add(1);
        let sender = (PAGE.system, PAGE.component);
        let frame = Frame::encode(&message.into(), Version::Two, self.onlooker.sequence, sender);
        if let Some(frame) = frame {
            self.take_in(number, &Received { origin: PAGE, frame }, now);
        }
    }
}
