//! What would be said over and over is said now and then.

use std::time::{Duration, Instant};

/// The least time between two of the same.
const PAUSE: Duration = Duration::from_secs(5);

/// When something was said last.
#[derive(Debug, Default)]
pub struct Rarely(Option<Instant>);

impl Rarely {
    /// Whether it is time to say it again. If so, it counts as said.
    pub fn is_due(&mut self, now: Instant) -> bool {
        let due = self.0.is_none_or(|last| now.saturating_duration_since(last) >= PAUSE);
        if due {
            self.0 = Some(now);
        }
        due
    }
}
