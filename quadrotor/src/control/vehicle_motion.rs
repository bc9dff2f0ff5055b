//! What the translational controllers know of the vehicle's motion, measured or estimated.

use nalgebra::{Matrix2, Vector2};

/// Motion north and east.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HorizontalMotion {
    /// Position, m.
    pub(crate) position_m: Vector2<f64>,
    /// Velocity, m/s.
    pub(crate) velocity_m_s: Vector2<f64>,
    /// Acceleration that the thrust makes, m/s².
    pub(crate) acceleration_m_s2: Vector2<f64>,
    /// Its rate as the body turns, m/s³.
    pub(crate) jerk_m_s3: Vector2<f64>,
    /// The rate of that by the torques that the rotors make, and as the body goes on turning, m/s⁴.
    pub(crate) snap_m_s4: Vector2<f64>,
    /// The same by the torques that feedback of the attitude has asked for, m/s⁴.
    pub(crate) asked_snap_m_s4: Vector2<f64>,
    /// Estimated acceleration that thrust and gravity do not explain, m/s².
    pub(crate) disturbance_m_s2: Vector2<f64>,
    /// How far that lags behind what it is, s.
    pub(crate) disturbance_lag_s: f64,
    /// Estimated angular acceleration about roll and pitch that torques do not explain, rad/s².
    pub(crate) disturbance_rad_s2: Vector2<f64>,
    /// By so much that changes under noise alone, rad/s².
    pub(crate) unsure_rad_s2: Vector2<f64>,
    /// Snap by such an angular acceleration, m/s⁴ per rad/s²: it turns with the body.
    pub(crate) snap_by_turning: Matrix2<f64>,
}

impl HorizontalMotion {
    /// Snap by what turns the body beside its rotors, m/s⁴.
    pub(crate) fn disturbance_m_s4(&self) -> Vector2<f64> {
        self.snap_by_turning * self.disturbance_rad_s2
    }
}

/// Motion down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct VerticalMotion {
    /// Position, m.
    pub(crate) position_m: f64,
    /// Velocity, m/s.
    pub(crate) velocity_m_s: f64,
    /// Acceleration that thrust and gravity make, m/s².
    pub(crate) acceleration_m_s2: f64,
    /// Estimated acceleration that they do not explain, m/s².
    pub(crate) disturbance_m_s2: f64,
}
