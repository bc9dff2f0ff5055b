//! What pushes the vehicle from outside.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Forces and torques from outside.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Disturbance {
    /// Force at the centre of mass, NED, N.
    pub force_n: Vector3<f64>,
    /// Torque, FRD, N·m.
    pub torque_n_m: Vector3<f64>,
    /// Wind that drag is relative to, NED, m/s.
    pub wind_m_s: Vector3<f64>,
}

impl Disturbance {
    /// The name of its first component that is not finite.
    pub(crate) fn not_finite(&self) -> Option<&'static str> {
        let finite = |vector: &Vector3<f64>| vector.iter().all(|value| value.is_finite());
        let checks = [
            ("disturbance.force", finite(&self.force_n)),
            ("disturbance.torque", finite(&self.torque_n_m)),
            ("wind.velocity", finite(&self.wind_m_s)),
        ];
        checks.into_iter().find(|(_, finite)| !finite).map(|(name, _)| name)
    }
}

#[cfg(test)]
mod tests {
    use super::Disturbance;

    #[test]
    fn the_first_component_that_is_not_finite_is_named() {
        let mut disturbance = Disturbance::default();
        assert_eq!(disturbance.not_finite(), None);
        disturbance.wind_m_s.z = f64::INFINITY;
        assert_eq!(disturbance.not_finite(), Some("wind.velocity"));
        disturbance.torque_n_m.y = f64::NAN;
        assert_eq!(disturbance.not_finite(), Some("disturbance.torque"));
        disturbance.force_n.x = f64::NAN;
        assert_eq!(disturbance.not_finite(), Some("disturbance.force"));
    }
}
