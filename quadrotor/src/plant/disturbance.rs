//! What pushes the vehicle from outside.

use nalgebra::{Scalar, Vector3};
use serde::{Deserialize, Serialize};

use crate::plant::differentiation::real::Real;

/// Forces and torques from outside.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound(serialize = "T: Scalar + Serialize", deserialize = "T: Scalar + Deserialize<'de>"))]
pub struct Disturbance<T = f64> {
    /// Force at the centre of mass, NED, N.
    pub force_n: Vector3<T>,
    /// Torque, FRD, N·m.
    pub torque_n_m: Vector3<T>,
    /// Wind that drag is relative to, NED, m/s.
    pub wind_m_s: Vector3<T>,
}

/// None, in still air.
impl<T: Real> Default for Disturbance<T> {
    fn default() -> Self {
        Self { force_n: Vector3::zeros(), torque_n_m: Vector3::zeros(), wind_m_s: Vector3::zeros() }
    }
}

impl<T: Scalar + Copy> Disturbance<T> {
    /// Made of each of the numbers of both disturbances.
    pub(crate) fn zip_map<U: Scalar + Copy, V: Scalar>(
        &self,
        other: &Disturbance<U>,
        f: impl Fn(T, U) -> V,
    ) -> Disturbance<V> {
        Disturbance {
            force_n: self.force_n.zip_map(&other.force_n, &f),
            torque_n_m: self.torque_n_m.zip_map(&other.torque_n_m, &f),
            wind_m_s: self.wind_m_s.zip_map(&other.wind_m_s, &f),
        }
    }
}

impl Disturbance {
    /// The name of its first component that is not finite.
    pub(crate) fn not_finite(&self) -> Option<&'static str> {
        // Zero times what is not finite is not a number, and neither is a sum with it. Mostly this is all there is to do.
        if (self.force_n * 0.0 + self.torque_n_m * 0.0 + self.wind_m_s * 0.0).sum() == 0.0 {
            return None;
        }
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
