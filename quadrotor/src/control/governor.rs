//! How much of a large error a linear controller may see.
//!
//! The unconstrained controllers know nothing of saturation: a large error would ask for a speed from
//! which the vehicle cannot brake in time. The governor shortens it.

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

/// κ of a controller whose set-point enters through the state as well: the rate at which the proportional
/// and the derivative term balance, K_position / K_rate.
pub(crate) fn proportional_rate<const N: usize, const P: usize>(
    law: &StateFeedback<N, P, P>,
    channel: usize,
) -> f64 {
    law.state_gain()[(channel, 2 * channel)] / law.state_gain()[(channel, 2 * channel + 1)]
}

