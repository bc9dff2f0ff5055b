//! The age of a point of a trajectory that is held until the next one is set.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::PositionReference;

/// Points that are set less often than this, µs, are set-points, not points of a trajectory.
const LONGEST_PERIOD_US: u64 = 300_000;

/// A reference as it comes: set each so often by somebody, and held in between.
///
/// A point of a trajectory holds at the instant at which it is set. An importer with a communication step of 100 ms leaves it up
/// to 100 ms old; at 5 m/s that is half a metre.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct HeldInput {
    /// Position, velocity and acceleration of the present point.
    held: [Vector3<f64>; 3],
    /// Since when, µs.
    since_us: u64,
    /// Time between the last two changes, µs; 0 if it is not known.
    period_us: u64,
}

impl HeldInput {
    /// A point that rests.
    pub fn new(time_us: u64) -> Self {
        Self { held: [Vector3::zeros(); 3], since_us: time_us, period_us: 0 }
    }

    /// The input at `time_us`.
    pub fn observe(&mut self, reference: &PositionReference, time_us: u64) {
        let now = [reference.position_m, reference.velocity_m_s, reference.acceleration_m_s2];
        if now != self.held {
            let period_us = time_us.saturating_sub(self.since_us);
            self.period_us = if period_us <= LONGEST_PERIOD_US { period_us } else { 0 };
            (self.held, self.since_us) = (now, time_us);
        }
    }

    /// The present point is elsewhere, m, and no older or newer for that.
    pub fn shift(&mut self, by_m: &Vector3<f64>) {
        self.held[0] += by_m;
    }

    /// When the present point was set, µs.
    pub fn since_us(&self) -> u64 {
        self.since_us
    }

    /// How old the present point is at `time_us`, s. If the next one does not come, it is not carried on for longer than one and
    /// a half periods.
    pub fn age_s(&self, time_us: u64) -> f64 {
        let age_us = time_us.saturating_sub(self.since_us);
        age_us.min(self.period_us + self.period_us / 2) as f64 / 1e6
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::HeldInput;
    use crate::PositionReference;

    fn point(x: f64) -> PositionReference {
        PositionReference { velocity_m_s: Vector3::x(), ..PositionReference::goal([x, 0.0, 0.0], 0.0) }
    }

    /// Looked at each millisecond.
    fn seen(at: impl Fn(u64) -> f64, until_ms: u64) -> HeldInput {
        let mut input = HeldInput::new(0);
        for millisecond in 0..=until_ms {
            input.observe(&point(at(millisecond)), millisecond * 1_000);
        }
        input
    }

    #[test]
    fn a_point_ages_between_two_updates_and_a_little_longer() {
        let each_100_ms = |millisecond: u64| (millisecond / 100) as f64;
        let input = seen(each_100_ms, 270);
        assert_eq!((input.age_s(270_000), input.since_us()), (0.07, 200_000));
        assert_eq!(input.age_s(349_000), 0.149);
        assert_eq!(input.age_s(900_000), 0.15);
    }

    #[test]
    fn a_continuous_input_and_a_set_point_do_not_age() {
        assert_eq!(seen(|millisecond| millisecond as f64, 270).age_s(270_000), 0.0);
        let rare = seen(|millisecond| (millisecond / 1_000) as f64, 1_500);
        assert_eq!(rare.age_s(1_500_000), 0.0);
    }
}
