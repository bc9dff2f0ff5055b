//! The reference that the cascade tracks.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::PositionReference;

/// One point of the trajectory that the cascade tracks.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Setpoint {
    /// Position, velocity, acceleration, heading and its rate.
    pub reference: PositionReference,
    /// Jerk, NED, m/s³.
    pub jerk_m_s3: Vector3<f64>,
}
