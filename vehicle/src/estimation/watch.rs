//! Whether an instrument still measures, and measures what it should.

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

/// Remembers which share of an instrument's readings fitted the estimate lately.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trust {
    share: f64,
}

/// How long a reading counts, s.
const MEMORY_S: f64 = 1.0;

impl Default for Trust {
    fn default() -> Self {
        Self { share: 1.0 }
    }
}

impl Trust {
    /// Takes in whether a reading fitted; one comes every `period_us`.
    pub fn update(&mut self, fitted: bool, period_us: u64) {
        let weight = period_us as f64 / 1e6 / MEMORY_S;
        self.share += (f64::from(u8::from(fitted)) - self.share) * weight;
    }

    /// Whether most of them did.
    pub fn is_deserved(&self) -> bool {
        self.share > 0.5
    }
}
