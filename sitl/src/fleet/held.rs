//! Messages that lock-step holds: a queue for each peer, and turns among the peers.

use std::collections::{BTreeMap, VecDeque};
use std::time::Duration;

use autopilot::codec::{Frame, id};
use autopilot::envelope::PeerId;

use crate::link::{Received, Turns};

/// Messages of one peer that are held at most; more wait in its inbox.
const MOST_HELD: usize = 1_000;
/// A client that sends more set-points than it needs may be this many ahead. Beyond that the older ones take effect at
/// once, so that it is not heard later and later.
const MOST_SET_POINTS: usize = 1;

#[derive(Debug, Default)]
struct Queue {
    /// Each with the number of its arrival.
    messages: VecDeque<(u64, Received)>,
    set_points: usize,
}

/// Held messages. Those of a peer keep their order.
#[derive(Debug, Default)]
pub struct Held {
    queues: BTreeMap<PeerId, Queue>,
    turns: Turns<PeerId>,
    arrivals: u64,
}

impl Held {
    /// Whether a peer has to wait before more of its messages are taken.
    pub fn is_full(&self, peer: PeerId) -> bool {
        self.queues.get(&peer).is_some_and(|queue| queue.messages.len() >= MOST_HELD)
    }

    /// A message has come.
    pub fn put(&mut self, received: Received) {
        let queue = self.queues.entry(received.origin.peer).or_default();
        queue.set_points += usize::from(is_set_point(&received.frame));
        self.arrivals += 1;
        queue.messages.push_back((self.arrivals, received));
    }

    /// The next message; with `surplus_only`, only of a peer that has sent more set-points than it may be ahead.
    pub fn take(&mut self, surplus_only: bool) -> Option<Received> {
        let due = |queue: &Queue| !surplus_only || queue.set_points > MOST_SET_POINTS;
        let waiting = self.queues.iter().filter(|(_, queue)| due(queue));
        let heads = waiting.filter_map(|(peer, queue)| Some((*peer, queue.messages.front()?.0)));
        let peer = self.turns.next(heads)?;
        let queue = self.queues.get_mut(&peer)?;
        let (_, received) = queue.messages.pop_front()?;
        queue.set_points -= usize::from(is_set_point(&received.frame));
        if queue.messages.is_empty() {
            self.queues.remove(&peer);
        }
        Some(received)
    }

    /// The effect of a message of a peer has cost this much.
    pub fn charge(&mut self, peer: PeerId, cost: Duration) {
        self.turns.charge(peer, cost);
        self.turns.expect(peer, cost);
    }
}

/// Whether a message is one that lock-step waits for.
pub fn is_set_point(frame: &Frame) -> bool {
    matches!(
        frame.message_id(),
        id::SET_ATTITUDE_TARGET | id::SET_POSITION_TARGET_LOCAL_NED | id::SET_POSITION_TARGET_GLOBAL_INT
    )
}
