//! Random choices: the same on every machine for a seed.

use rand_core::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;

pub struct Chance(Pcg64Mcg);

impl Chance {
    pub fn new(seed: u64) -> Self {
        Self(Pcg64Mcg::seed_from_u64(seed))
    }

    /// In [0, 1).
    pub fn share(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    pub fn one_of<T: Clone>(&mut self, choices: &[T]) -> T {
        choices[(self.share() * choices.len() as f64) as usize].clone()
    }

    pub fn seconds_us(&mut self, low: f64, high: f64) -> u64 {
        (self.within(low, high) * 1e6) as u64
    }
}
