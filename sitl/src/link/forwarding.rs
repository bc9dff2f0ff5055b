//! What a peer may have forwarded: a share of what the others can be expected to read beside their own telemetry.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use autopilot::envelope::PeerId;

/// The shares begin again this often.
const WINDOW: Duration = Duration::from_millis(100);
/// Frames of one window, of all peers together: 4,000 a second, ten times what a vehicle sends to an onboard computer.
const MOST: usize = 400;

/// Counts the frames of each peer that are forwarded.
#[derive(Debug, Default)]
pub struct Forwarding {
    window: Option<Instant>,
    forwarded: BTreeMap<PeerId, usize>,
    /// Peers that had something to forward in the window before.
    sources: usize,
}

impl Forwarding {
    /// Whether a frame of a peer is within its share, which it then uses up.
    pub fn allows(&mut self, from: PeerId, now: Instant) -> bool {
        let over = self.window.is_none_or(|begun| now.saturating_duration_since(begun) >= WINDOW);
        if over {
            self.sources = self.forwarded.len();
            self.forwarded.clear();
            self.window = Some(now);
        }
        let count = self.forwarded.entry(from).or_default();
        *count += 1;
        let count = *count;
        count <= MOST / self.forwarded.len().max(self.sources)
    }
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use super::{Forwarding, MOST, PeerId, WINDOW};

    fn peer(number: u64) -> PeerId {
        PeerId { link: 0, number }
    }

    #[test]
    fn a_flood_leaves_the_others_their_share() {
        let (mut forwarding, now) = (Forwarding::default(), Instant::now());
        let flood = |forwarding: &mut Forwarding, from, now| {
            (0..10_000).filter(|_| forwarding.allows(peer(from), now)).count()
        };
        assert_eq!(flood(&mut forwarding, 1, now), MOST);
        assert!(forwarding.allows(peer(2), now), "who forwards little is not held up");
        // Who floods together shares what one would have had.
        let later = now + WINDOW;
        assert_eq!(flood(&mut forwarding, 1, later), MOST / 2);
        assert_eq!(flood(&mut forwarding, 2, later), MOST / 2);
        // Who is alone again has all.
        assert_eq!(flood(&mut forwarding, 1, later + WINDOW), MOST / 2);
        assert_eq!(flood(&mut forwarding, 1, later + 2 * WINDOW), MOST);
    }
}
