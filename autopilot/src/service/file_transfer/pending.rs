//! Requests that are being worked on, and replies that wait for room.

use std::collections::VecDeque;

use mavlink::dialects::ardupilotmega::MavMessage;

use super::message::{Client, Reply, Request};
use crate::envelope::{Origin, PeerId};
use crate::speaker::Speaker;
use crate::turns::Turns;

/// Requests of one peer that are worked on at the same time: ten times what clients have.
const MOST_OF_ONE: usize = 32;
/// And of all of them.
const MOST: usize = 256;

/// A request, and what is still to be sent of its answer.
#[derive(Debug)]
struct Waiting {
    number: u64,
    origin: Origin,
    /// Who was asked, and answers.
    asked: Speaker,
    request: Request,
    /// Sequence of the latest reply.
    sequence: u16,
    /// `None`: it is not answered yet.
    replies: Option<VecDeque<Reply>>,
}

/// All of them in the order in which they came.
#[derive(Debug, Default)]
pub struct Pending {
    all: Vec<Waiting>,
    next_number: u64,
    turns: Turns,
}

impl Pending {
    /// Whether there are any.
    pub fn are_there(&self) -> bool {
        !self.all.is_empty()
    }

    /// Whether a request is being worked on, or its answer is on its way. It is answered where it was asked last.
    pub fn is_known(&mut self, origin: &Origin, request: &Request) -> bool {
        let client = client_of(origin);
        let same =
            |waiting: &&mut Waiting| client_of(&waiting.origin) == client && waiting.request == *request;
        let known = self.all.iter_mut().find(same);
        known.map(|waiting| waiting.origin = *origin).is_some()
    }

    /// A number for a request of a peer; `None`: it has to wait until others are answered.
    pub fn admit(&mut self, peer: PeerId) -> Option<u64> {
        let own = self.all.iter().filter(|waiting| waiting.origin.peer == peer).count();
        if own >= MOST_OF_ONE || self.all.len() >= MOST {
            return None;
        }
        self.next_number += 1;
        Some(self.next_number)
    }

    /// A request is being worked on.
    pub fn add(&mut self, number: u64, origin: Origin, asked: Speaker, request: Request) {
        let sequence = request.sequence;
        self.all.push(Waiting { number, origin, asked, request, sequence, replies: None });
    }

    /// Takes the replies to a request in.
    pub fn answer(&mut self, number: u64, replies: Vec<Reply>) {
        if let Some(waiting) = self.all.iter_mut().find(|waiting| waiting.number == number) {
            waiting.replies = Some(replies.into());
        }
    }

    /// Forgets peers that are gone.
    pub fn retain(&mut self, is_there: impl Fn(PeerId) -> bool) {
        self.all.retain(|waiting| is_there(waiting.origin.peer));
    }

    /// The next reply, whom it is for, and who was asked.
    pub fn next(&mut self, is_ready: impl Fn(PeerId) -> bool) -> Option<(PeerId, Speaker, MavMessage)> {
        let answered = self.all.iter().filter(|waiting| waiting.replies.is_some());
        let peer =
            self.turns.next(answered.map(|waiting| waiting.origin.peer).filter(|peer| is_ready(*peer)))?;
        let place =
            self.all.iter().position(|waiting| waiting.origin.peer == peer && waiting.replies.is_some())?;
        let waiting = self.all.get_mut(place)?;
        let asked = waiting.asked;
        let reply = waiting.replies.as_mut().and_then(VecDeque::pop_front);
        waiting.sequence = waiting.sequence.wrapping_add(1);
        let message =
            reply.map(|reply| reply.encode(&waiting.origin, waiting.request.opcode, waiting.sequence));
        if waiting.replies.as_ref().is_none_or(VecDeque::is_empty) {
            self.all.remove(place);
        }
        Some((peer, asked, message?))
    }
}

fn client_of(origin: &Origin) -> Client {
    (origin.system, origin.component)
}
