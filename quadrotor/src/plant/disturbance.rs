//! What pushes the vehicle from outside.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::{Airframe, External};

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
    /// The disturbance and the linear drag on a body that moves with `velocity_m_s` in NED.
    pub(crate) fn external(&self, airframe: &Airframe, velocity_m_s: &Vector3<f64>) -> External {
        let drag = Vector3::from(airframe.drag_n_s_m).component_mul(&(velocity_m_s - self.wind_m_s));
        External { force_n: self.force_n - drag, torque_n_m: self.torque_n_m }
    }

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
    use nalgebra::Vector3;

    use super::Disturbance;
    use crate::Airframe;

    /// A tail wind pushes, a head wind brakes: f − c (v − w), each axis with its own coefficient.
    #[test]
    fn drag_is_that_of_the_motion_through_the_air() {
        let airframe = Airframe { drag_n_s_m: [0.1, 0.2, 0.4], ..Airframe::default() };
        let disturbance = Disturbance {
            force_n: Vector3::new(1.0, 2.0, 3.0),
            torque_n_m: Vector3::new(0.1, 0.2, 0.3),
            wind_m_s: Vector3::new(5.0, -5.0, 1.0),
        };
        let external = disturbance.external(&airframe, &Vector3::new(2.0, 5.0, -4.0));
        let expected = Vector3::new(1.0 + 0.1 * 3.0, 2.0 - 0.2 * 10.0, 3.0 + 0.4 * 5.0);
        assert!((external.force_n - expected).norm() < 1e-14);
        assert_eq!(external.torque_n_m, disturbance.torque_n_m);
    }

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
