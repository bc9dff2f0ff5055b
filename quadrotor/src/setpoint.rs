//! The reference that the cascade tracks.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::PositionReference;

/// One point of the trajectory that the cascade tracks.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Setpoint {
    /// Position, velocity, acceleration, heading and its rate.
    pub reference: PositionReference,
    /// Jerk in NED, m/s³.
    pub jerk_m_s3: Vector3<f64>,
}

impl Setpoint {
    /// A place to stay at.
    pub fn hold(position_m: &Vector3<f64>, yaw_rad: f64) -> Self {
        Self {
            reference: PositionReference::goal((*position_m).into(), yaw_rad),
            jerk_m_s3: Vector3::zeros(),
        }
    }
}
