//! What a translational controller knows of the vehicle's motion.

use nalgebra::SVector;

/// Motion on some axes of NED, measured or estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct VehicleMotion<const AXES: usize> {
    /// Position, m.
    pub(crate) position_m: SVector<f64, AXES>,
    /// Velocity, m/s.
    pub(crate) velocity_m_s: SVector<f64, AXES>,
    /// Estimated acceleration that thrust and gravity do not explain, m/s².
    pub(crate) disturbance_m_s2: SVector<f64, AXES>,
}
