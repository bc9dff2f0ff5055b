//! The reference that the cascade tracks.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::PositionReference;

/// One point of the trajectory that the cascade tracks.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Setpoint {
    /// Position and heading with their derivatives.
    pub reference: PositionReference,
    /// Acceleration a little later, NED, m/s²: when the command that is computed now takes effect.
    pub acceleration_ahead_m_s2: Vector3<f64>,
}
