//! Something that is switched back and forth.

/// Cycles that are left. Each has two halves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Repetition {
    halves: u32,
    half_us: u64,
    next_us: u64,
}

impl Repetition {
    /// Cycles that begin now, each of a period, s.
    pub fn new(cycles: u32, period_s: f64, now_us: u64) -> Self {
        let half_us = ((period_s * 0.5e6) as u64).max(1);
        Self { halves: cycles.saturating_mul(2), half_us, next_us: now_us }
    }

    /// What is due by now: true begins a cycle, false is the way back.
    pub fn due(&mut self, now_us: u64) -> Option<bool> {
        if self.halves == 0 || now_us < self.next_us {
            return None;
        }
        self.next_us += self.half_us;
        self.halves -= 1;
        Some(self.halves % 2 == 1)
    }

    /// Whether all of it is done.
    pub fn is_over(&self) -> bool {
        self.halves == 0
    }
}

#[cfg(test)]
mod tests {
    use super::Repetition;

    #[test]
    fn it_goes_there_and_back_as_often_as_asked() {
        let mut repetition = Repetition::new(2, 1.0, 1_000);
        let seen: Vec<_> = (0..4_000_000)
            .step_by(1_000)
            .filter_map(|now_us| repetition.due(now_us).map(|there| (now_us, there)))
            .collect();
        assert_eq!(seen, [(1_000, true), (501_000, false), (1_001_000, true), (1_501_000, false)]);
        assert!(repetition.is_over());
    }
}
