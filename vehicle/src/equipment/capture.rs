//! Images that a client asks for: one, or one after the other.

/// The camera needs this long for an image, s.
pub const SHORTEST_S: f64 = 0.1;

/// Images that are still to be taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capture {
    interval_us: u64,
    /// `None`: until it is stopped.
    left: Option<u32>,
    next_us: u64,
}

impl Capture {
    /// So many images, one each interval, s, the first one now; 0 images: until it is stopped.
    pub fn new(interval_s: f64, count: u32, now_us: u64) -> Self {
        let interval_us = (interval_s.max(SHORTEST_S) * 1e6) as u64;
        Self { interval_us, left: (count > 0).then_some(count), next_us: now_us }
    }

    /// Interval, s.
    pub fn interval_s(&self) -> f64 {
        self.interval_us as f64 / 1e6
    }

    /// Whether another one will follow.
    pub fn goes_on(&self) -> bool {
        self.left != Some(0)
    }

    /// Whether one is due now.
    pub fn is_due(&mut self, now_us: u64) -> bool {
        if !self.goes_on() || now_us < self.next_us {
            return false;
        }
        self.next_us += self.interval_us;
        self.left = self.left.map(|left| left - 1);
        true
    }
}
