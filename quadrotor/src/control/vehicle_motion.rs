//! What a translational controller knows of the vehicle's motion.

use nalgebra::SVector;

/// Motion on some axes of NED, measured or estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct VehicleMotion<const AXES: usize> {
    /// Position, m.
    pub(crate) position_m: SVector<f64, AXES>,
    /// Velocity, m/s.
    pub(crate) velocity_m_s: SVector<f64, AXES>,
    /// Acceleration that thrust and gravity make, m/s².
    pub(crate) acceleration_m_s2: SVector<f64, AXES>,
    /// Its rate as the body turns, m/s³.
    pub(crate) jerk_m_s3: SVector<f64, AXES>,
    /// Estimated acceleration that thrust and gravity do not explain, m/s².
    pub(crate) disturbance_m_s2: SVector<f64, AXES>,
}
