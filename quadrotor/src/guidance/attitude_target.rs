//! An attitude and a thrust to fly, past the position and altitude controllers.

use nalgebra::{UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

/// What the attitude controller tracks while position and altitude are left to whoever commands it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AttitudeTarget {
    /// The attitude, FRD into NED.
    pub attitude: UnitQuaternion<f64>,
    /// Rate with which that attitude turns, in its own axes, rad/s.
    pub body_rate_rad_s: Vector3<f64>,
    /// Thrust of the four rotors, N; what they cannot do is clamped.
    pub thrust_n: f64,
}

impl AttitudeTarget {
    pub(crate) fn is_finite(&self) -> bool {
        self.attitude.coords.iter().chain(&self.body_rate_rad_s).all(|value| value.is_finite())
            && self.thrust_n.is_finite()
    }
}
