//! Frames that come again by another way.

use std::collections::{BTreeMap, HashMap, VecDeque};
use std::sync::Arc;
use std::time::{Duration, Instant};

use autopilot::codec::Frame;
use autopilot::envelope::PeerId;

/// A frame that comes again within this time by another way is the same frame.
const LATEST: Duration = Duration::from_millis(500);
/// Frames of each peer that are remembered: a flood makes the sender's own frames forgotten, and nobody else's.
const MOST: usize = 512;

/// Frames of a peer with the times when they came, oldest first.
type Order = VecDeque<(Arc<[u8]>, Instant)>;

/// Frames that have come lately, and from whom.
#[derive(Debug, Default)]
pub struct Echoes {
    /// From whom a frame has come, and when it came from there last.
    seen: HashMap<Arc<[u8]>, (PeerId, Instant)>,
    order: BTreeMap<PeerId, Order>,
}

impl Echoes {
    /// Whether a frame has come lately from another peer.
    pub fn has(&self, frame: &Frame, from: PeerId, now: Instant) -> bool {
        let seen = self.seen.get(frame.bytes());
        seen.is_some_and(|(by, when)| *by != from && is_lately(*when, now))
    }

    /// Remembers a frame that is no echo; the oldest of its peer makes room.
    pub fn remember(&mut self, frame: &Frame, from: PeerId, now: Instant) {
        let order = self.order.entry(from).or_default();
        while order.len() >= MOST || order.front().is_some_and(|(_, when)| !is_lately(*when, now)) {
            let Some((oldest, when)) = order.pop_front() else { break };
            // It may have come again since.
            if self.seen.get(&oldest) == Some(&(from, when)) {
                self.seen.remove(&oldest);
            }
        }
        let bytes: Arc<[u8]> = frame.bytes().into();
        order.push_back((Arc::clone(&bytes), now));
        self.seen.insert(bytes, (from, now));
    }

    /// A peer is gone.
    pub fn forget(&mut self, peer: PeerId) {
        for (frame, _) in self.order.remove(&peer).into_iter().flatten() {
            if self.seen.get(&frame).is_some_and(|(by, _)| *by == peer) {
                self.seen.remove(&frame);
            }
        }
    }
}

fn is_lately(when: Instant, now: Instant) -> bool {
    now.saturating_duration_since(when) <= LATEST
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use mavlink::dialects::ardupilotmega::{MavMessage, SYSTEM_TIME_DATA};

    use super::{Echoes, LATEST, MOST};
    use autopilot::codec::{Frame, Version};
    use autopilot::envelope::PeerId;

    fn frame(time_unix_usec: u64) -> Frame {
        let message =
            MavMessage::SYSTEM_TIME(SYSTEM_TIME_DATA { time_unix_usec, ..SYSTEM_TIME_DATA::default() });
        Frame::encode(&message.into(), Version::Two, 0, (255, 190)).expect("a message of MAVLink 2")
    }

    #[test]
    fn echoes_are_known_for_a_while() {
        let [one, other] = [1, 2].map(|number| PeerId { link: 0, number });
        let now = Instant::now();
        let mut echoes = Echoes::default();
        echoes.remember(&frame(0), one, now);
        assert!(echoes.has(&frame(0), other, now + LATEST));
        assert!(!echoes.has(&frame(0), one, now), "who repeats itself is heard again");
        assert!(!echoes.has(&frame(1), other, now));
        assert!(!echoes.has(&frame(0), other, now + 2 * LATEST));
        // What has come again counts from then.
        echoes.remember(&frame(0), one, now + LATEST);
        echoes.remember(&frame(1), one, now + LATEST * 3 / 2);
        assert!(echoes.has(&frame(0), other, now + 2 * LATEST));
    }

    #[test]
    fn a_flood_is_bounded_and_makes_no_one_elses_frames_forgotten() {
        let [one, other] = [1, 2].map(|number| PeerId { link: 0, number });
        let now = Instant::now();
        let mut echoes = Echoes::default();
        echoes.remember(&frame(u64::MAX), other, now);
        (0..2 * MOST as u64).for_each(|number| echoes.remember(&frame(number), one, now));
        assert_eq!((echoes.seen.len(), echoes.order[&one].len()), (MOST + 1, MOST));
        assert!(echoes.has(&frame(2 * MOST as u64 - 1), other, now) && !echoes.has(&frame(0), other, now));
        assert!(echoes.has(&frame(u64::MAX), one, now));
        echoes.remember(&frame(7), one, now + 2 * LATEST);
        assert_eq!(
            (echoes.seen.len(), echoes.order[&one].len()),
            (2, 1),
            "what is old goes when the peer speaks"
        );
        [one, other].into_iter().for_each(|peer| echoes.forget(peer));
        assert!(echoes.seen.is_empty() && echoes.order.is_empty());
    }
}
