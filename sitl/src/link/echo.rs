//! Frames that come again by another way.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use autopilot::codec::Frame;
use autopilot::envelope::PeerId;

/// A frame that comes again within this time by another way is the same frame.
const LATEST: Duration = Duration::from_millis(500);
/// Frames that are remembered: each is compared with all of them, and a flood must not keep the vehicle from flying.
const MOST: usize = 1024;

/// Frames that have come lately, and from whom.
#[derive(Debug, Default)]
pub struct Echoes(VecDeque<(Vec<u8>, PeerId, Instant)>);

impl Echoes {
    /// Whether a frame has come lately from another peer.
    pub fn has(&mut self, frame: &Frame, from: PeerId, now: Instant) -> bool {
        while self.0.front().is_some_and(|(_, _, when)| now.saturating_duration_since(*when) > LATEST) {
            self.0.pop_front();
        }
        self.0.iter().any(|(seen, by, _)| *by != from && seen == frame.bytes())
    }

    /// Remembers a frame; the oldest makes room.
    pub fn remember(&mut self, frame: &Frame, from: PeerId, now: Instant) {
        if self.0.len() >= MOST {
            self.0.pop_front();
        }
        self.0.push_back((frame.bytes().to_vec(), from, now));
    }
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use mavlink::dialects::common::{MavMessage, SYSTEM_TIME_DATA};

    use super::{Echoes, LATEST, MOST};
    use autopilot::codec::{Frame, Version};
    use autopilot::envelope::PeerId;

    fn frame(time_unix_usec: u64) -> Frame {
        let message =
            MavMessage::SYSTEM_TIME(SYSTEM_TIME_DATA { time_unix_usec, ..SYSTEM_TIME_DATA::default() });
        Frame::encode(&message.into(), Version::Two, 0, (255, 190)).expect("a message of MAVLink 2")
    }

    #[test]
    fn echoes_are_known_for_a_while_and_a_flood_is_bounded() {
        let [one, other] = [1, 2].map(|number| PeerId { link: 0, number });
        let now = Instant::now();
        let mut echoes = Echoes::default();
        echoes.remember(&frame(0), one, now);
        assert!(echoes.has(&frame(0), other, now + LATEST));
        assert!(!echoes.has(&frame(0), one, now), "who repeats itself is heard again");
        assert!(!echoes.has(&frame(1), other, now));
        assert!(!echoes.has(&frame(0), other, now + 2 * LATEST));
        (0..2 * MOST as u64).for_each(|number| echoes.remember(&frame(number), one, now));
        assert_eq!(echoes.0.len(), MOST);
        assert!(echoes.has(&frame(2 * MOST as u64 - 1), other, now) && !echoes.has(&frame(0), other, now));
    }
}
