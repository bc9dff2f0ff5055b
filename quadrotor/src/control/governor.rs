//! How much of a large error the regulator may see.
//!
//! It knows nothing of limits: a large error would ask for a speed from which the vehicle cannot brake in time. The governor
//! shortens it. The predictive controllers need none.

use lmpc::StateFeedback;
use nalgebra::SVector;

/// Bounds on the speed with which an error is closed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Governor {
    /// κ, speed per error at which the linear controller closes a small error, 1/s.
    pub(crate) rate: f64,
    /// Deceleration that is counted on for braking.
    pub(crate) deceleration: f64,
    /// Largest speed.
    pub(crate) speed: f64,
}

impl Governor {
    /// The part of an error of size `error` ≥ 0 that the controller sees, so that it closes it with
    ///
    /// ```text
    /// v = κ e                       for e ≤ e₁ = d/κ²
    /// v = √(2 d (e − e₁/2))         beyond, which is the speed that deceleration d brakes in time
    /// v ≤ speed
    /// ```
    pub(crate) fn seen(&self, error: f64) -> f64 {
        let linear_end = self.deceleration / (self.rate * self.rate);
        let speed = if error <= linear_end {
            // Exactly the error unless the speed limits it.
            return error.min(self.speed / self.rate);
        } else {
            libm::sqrt(2.0 * self.deceleration * (error - linear_end / 2.0))
        };
        speed.min(self.speed) / self.rate
    }

    /// [`Governor::seen`] of a vector: its direction is kept.
    pub(crate) fn seen_vector<const D: usize>(&self, error: &SVector<f64, D>) -> SVector<f64, D> {
        // The square of a finite number can be infinite.
        let unit = error.amax().max(1.0);
        let size = unit * (error / unit).norm();
        let seen = self.seen(size);
        if seen < size { error / unit * (seen / (size / unit)) } else { *error }
    }
}

/// κ of a regulator whose set-point enters through the output error alone: the speed at which the integral of the error and the
/// proportional term balance, K_y / (T K_x).
///
/// Channel by channel, the states are the output and its derivatives.
pub(crate) fn integral_rate<const N: usize, const P: usize>(
    law: &StateFeedback<N, P, P>,
    channel: usize,
    sample_time_s: f64,
) -> f64 {
    law.output_gain()[(channel, channel)] / (law.state_gain()[(channel, N / P * channel)] * sample_time_s)
}

#[cfg(test)]
mod tests {
    use lmpc::StateFeedback;
    use nalgebra::{DMatrix, Vector2};

    use super::{Governor, integral_rate};

    /// κ = 2, d = 8: linear up to e₁ = 2.
    const GOVERNOR: Governor = Governor { rate: 2.0, deceleration: 8.0, speed: 100.0 };

    #[test]
    fn small_errors_are_seen_whole() {
        for error in [0.0, 0.3, 1.999, 2.0] {
            assert_eq!(GOVERNOR.seen(error), error);
        }
    }

    /// From the speed κ · seen, braking with d over the whole error ends in the linear law, which takes e₁/2 more than
    /// braking: v² / 2d = e − e₁/2.
    #[test]
    fn large_errors_are_closed_with_a_speed_that_can_be_braked() {
        for error in [2.000_001, 3.0, 7.5, 200.0] {
            let speed = 2.0 * GOVERNOR.seen(error);
            assert!((speed * speed / 16.0 - (error - 1.0)).abs() < 1e-12 * error, "{error}: {speed}");
        }
    }

    #[test]
    fn the_speed_is_bounded_for_small_errors_as_for_large_ones() {
        let slow = Governor { speed: 3.0, ..GOVERNOR };
        assert_eq!((slow.seen(1.4), slow.seen(1.6), slow.seen(50.0)), (1.4, 1.5, 1.5));
    }

    #[test]
    fn a_vector_is_shortened_and_not_turned() {
        let slow = Governor { speed: 3.0, ..GOVERNOR };
        assert!((slow.seen_vector(&Vector2::new(-30.0, 40.0)) - Vector2::new(-0.9, 1.2)).norm() < 1e-15);
        assert_eq!(slow.seen_vector(&Vector2::new(0.3, -0.4)), Vector2::new(0.3, -0.4));
        assert_eq!(slow.seen_vector(&Vector2::zeros()), Vector2::zeros());
    }

    /// Position and rate of two channels, then the two outputs.
    #[test]
    fn rates_are_ratios_of_a_channels_own_gains() {
        let gain =
            DMatrix::from_row_slice(2, 6, &[10.0, 5.0, 0.1, 0.2, 3.0, 0.3, 0.4, 0.5, 8.0, 32.0, 0.6, 2.0]);
        let law = StateFeedback::<4, 2, 2>::new(&gain).unwrap();
        assert!((integral_rate(&law, 0, 0.05) - 3.0 / (10.0 * 0.05)).abs() < 1e-12);
        assert!((integral_rate(&law, 1, 0.05) - 2.0 / (8.0 * 0.05)).abs() < 1e-12);
    }
}
