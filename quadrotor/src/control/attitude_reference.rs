//! What the attitude controller tracks at one sample.

use nalgebra::{UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

/// Time over which steps of the reference's rate are spread, s: those of the position controller.
pub(crate) const SMOOTHING_S: f64 = 0.05;

/// An attitude and how it moves, in its own axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AttitudeReference {
    /// FRD into NED.
    pub(crate) attitude: UnitQuaternion<f64>,
    /// rad/s.
    pub(crate) rate_rad_s: Vector3<f64>,
    /// rad/s².
    pub(crate) acceleration_rad_s2: Vector3<f64>,
    /// Derivative of the acceleration, rad/s³, by which the rotors must be ahead; 0 if it is not known.
    pub(crate) jerk_rad_s3: Vector3<f64>,
}

/// The angular acceleration of a reference whose rate is all that is known.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct SmoothedAcceleration {
    rate_rad_s: Vector3<f64>,
    /// Smoothed: the rate itself moves in steps.
    acceleration_rad_s2: Vector3<f64>,
}

impl SmoothedAcceleration {
    /// Takes in the rate of a sample, rad/s, so long after the last one: the acceleration, rad/s².
    pub(crate) fn go_on(&mut self, rate_rad_s: &Vector3<f64>, interval_s: f64) -> Vector3<f64> {
        let acceleration = (rate_rad_s - self.rate_rad_s) / interval_s;
        let share = (interval_s / SMOOTHING_S).min(1.0);
        self.acceleration_rad_s2 += (acceleration - self.acceleration_rad_s2) * share;
        self.rate_rad_s = *rate_rad_s;
        self.acceleration_rad_s2
    }
}
