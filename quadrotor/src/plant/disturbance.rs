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
