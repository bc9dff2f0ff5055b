//! Where the nose points.

use serde::{Deserialize, Serialize};

use crate::PositionReference;

/// Heading ψ, rad, and its rate, rad/s.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Heading {
    /// ψ, rad; any number of turns.
    pub yaw_rad: f64,
    /// Its rate, rad/s.
    pub yaw_rate_rad_s: f64,
}

impl Heading {
    /// That of a reference.
    pub fn of(reference: &PositionReference) -> Self {
        Self { yaw_rad: reference.yaw_rad, yaw_rate_rad_s: reference.yaw_rate_rad_s }
    }
}
