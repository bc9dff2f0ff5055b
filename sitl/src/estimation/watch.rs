//! Whether an instrument still measures.

/// Remembers when a reading last differed from the one before: a real one never reads the same for long.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Watch {
    latest: Option<[f64; 3]>,
    changed_us: u64,
}

impl Watch {
    /// Takes a reading in.
    pub fn update(&mut self, time_us: u64, reading: [f64; 3]) {
        if self.latest != Some(reading) {
            (self.latest, self.changed_us) = (Some(reading), time_us);
        }
    }

    /// Whether there was something new within `patience_us` before `time_us`.
    pub fn is_alive(&self, time_us: u64, patience_us: u64) -> bool {
        self.latest.is_some() && time_us.saturating_sub(self.changed_us) <= patience_us
    }
}
