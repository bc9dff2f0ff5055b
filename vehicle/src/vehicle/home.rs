//! Home.

use nalgebra::Vector3;

/// Where a return goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Home {
    /// NED, m.
    pub position_m: Vector3<f64>,
    /// Heading there, rad.
    pub yaw_rad: f64,
    /// Whether a user has set it: then arming does not move it.
    pub set_by_user: bool,
}
