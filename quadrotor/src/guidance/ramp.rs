//! A command that moves evenly from one sample's value to the next.

use nalgebra::SVector;
use serde::{Deserialize, Serialize};

/// Share of the admissible deceleration that is counted on to stop at a goal: the rest is for the
/// coarseness of the samples.
const STOPPING_SHARE: f64 = 0.7;

/// A command that reaches the newest value one sample after it was computed.
///
/// A controller that samples faster so sees a continuous reference, with a rate, instead of steps.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ramp<const AXES: usize> {
    from: SVector<f64, AXES>,
    to: SVector<f64, AXES>,
    start_us: u64,
    /// Sample time of the controller that computed it, µs.
    period_us: u64,
}

impl<const AXES: usize> Ramp<AXES> {
    /// At zero.
    pub fn still(time_us: u64) -> Self {
        Self { from: SVector::zeros(), to: SVector::zeros(), start_us: time_us, period_us: 1 }
    }

    /// The command at `time_us`; it stays at the newest value when no newer one comes.
    pub fn at(&self, time_us: u64) -> SVector<f64, AXES> {
        self.from + (self.to - self.from) * self.share(time_us).min(1.0)
    }

    /// As [`Ramp::at`], for a time before the next value is known: beyond the newest one it goes on evenly.
    pub fn ahead(&self, time_us: u64) -> SVector<f64, AXES> {
        self.from + (self.to - self.from) * self.share(time_us).min(2.0)
    }

    fn share(&self, time_us: u64) -> f64 {
        time_us.saturating_sub(self.start_us) as f64 / self.period_us as f64
    }

    /// From where it is now to `to`, one sample later.
    pub fn go_to(&mut self, to: SVector<f64, AXES>, time_us: u64, period_us: u64) {
        *self = Self { from: self.at(time_us), to, start_us: time_us, period_us };
    }

    /// The same motion in other terms.
    pub fn map(&self, term: impl Fn(&SVector<f64, AXES>) -> SVector<f64, AXES>) -> Self {
        Self { from: term(&self.from), to: term(&self.to), ..*self }
    }

    /// Where to be one sample later on the way to `goal`, with a speed of at most `rate` per second that
    /// changes by at most `acceleration` per second squared and comes to rest at the goal.
    pub fn towards(
        &self,
        goal: SVector<f64, AXES>,
        rate: f64,
        acceleration: f64,
        time_us: u64,
        period_us: u64,
    ) -> SVector<f64, AXES> {
        let period_s = period_us as f64 / 1e6;
        let from = self.at(time_us);
        let way = goal - from;
        let distance = way.norm();
        // v = √(2 a d) comes to rest after d
        let stopping = libm::sqrt(2.0 * STOPPING_SHARE * acceleration * distance);
        let speed = rate.min(stopping).min(distance / period_s);
        let wanted = if distance > 0.0 { way * (speed / distance) } else { SVector::zeros() };

        let before = (self.to - self.from) / (self.period_us as f64 / 1e6);
        let change = wanted - before;
        let most = acceleration * period_s;
        let norm = change.norm();
        let velocity = if norm > most { before + change * (most / norm) } else { wanted };
        from + velocity * period_s
    }
}
