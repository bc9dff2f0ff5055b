//! What a control law commands.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::{Airframe, Wrench, wrench_of_rotors};

/// Speeds that the rotors are commanded to turn with, and the thrust and torques that they stand for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct RotorCommand {
    /// In the order of the airframe's layout, rad/s.
    pub(crate) speed_rad_s: [f64; 4],
    /// Thrust and torques after the allocation and its limits: what a first-order lag of the thrusts answers to. The speeds lead it.
    pub(crate) wrench: Wrench,
}

impl RotorCommand {
    /// Speeds that are meant to be held, and the thrust and torques that rotors make with them.
    pub(crate) fn held(airframe: &Airframe, speed_rad_s: [f64; 4]) -> Self {
        Self { speed_rad_s, wrench: wrench_of_rotors(airframe, &speed_rad_s) }
    }

    /// Rotors at rest.
    pub(crate) fn none() -> Self {
        Self { speed_rad_s: [0.0; 4], wrench: Wrench { thrust_n: 0.0, torque_n_m: Vector3::zeros() } }
    }
}
