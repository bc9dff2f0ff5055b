//! Where the nose points.

use serde::{Deserialize, Serialize};

use crate::PositionReference;

/// Heading ψ with its derivatives.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Heading {
    /// ψ, rad; any number of turns.
    pub yaw_rad: f64,
    /// Its rate, rad/s.
    pub yaw_rate_rad_s: f64,
    /// Its angular acceleration, rad/s².
    pub yaw_acceleration_rad_s2: f64,
}

impl Heading {
    /// A heading, rad, that does not turn.
    pub fn fixed(yaw_rad: f64) -> Self {
        Self { yaw_rad, yaw_rate_rad_s: 0.0, yaw_acceleration_rad_s2: 0.0 }
    }

    /// That of a reference.
    pub fn of(reference: &PositionReference) -> Self {
        Self {
            yaw_rad: reference.yaw_rad,
            yaw_rate_rad_s: reference.yaw_rate_rad_s,
            yaw_acceleration_rad_s2: reference.yaw_acceleration_rad_s2,
        }
    }

    /// The same way with this heading.
    pub fn on(&self, way: &PositionReference) -> PositionReference {
        PositionReference {
            yaw_rad: self.yaw_rad,
            yaw_rate_rad_s: self.yaw_rate_rad_s,
            yaw_acceleration_rad_s2: self.yaw_acceleration_rad_s2,
            ..*way
        }
    }
}
