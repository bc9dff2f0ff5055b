//! What acts on the plant: u of f(x, u).

use serde::{Deserialize, Serialize};

use crate::{Disturbance, RotorFault, Wrench};

/// What drives the vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Actuation {
    /// Commanded speeds of the rotors, rad/s, which follow with their lag.
    RotorSpeeds([f64; 4]),
    /// Thrust and torques at once, in place of the rotors: their own speeds stay as they are, and neither their faults nor
    /// their spin, the air around them or the battery matter.
    Wrench(Wrench),
}

/// All inputs of a [`Plant`](crate::Plant), constant over a step.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct PlantInputs {
    /// What drives it.
    pub actuation: Actuation,
    /// Wind, external force and torque.
    pub disturbance: Disturbance,
    /// What is wrong with each rotor, in the order of the airframe's layout.
    pub rotor_faults: [Option<RotorFault>; 4],
}

/// Rotors that are commanded to stand still.
impl Default for Actuation {
    fn default() -> Self {
        Self::RotorSpeeds([0.0; 4])
    }
}

impl PlantInputs {
    /// Commanded rotor speeds, rad/s, in still air.
    pub fn rotor_speeds(command_rad_s: [f64; 4]) -> Self {
        Self { actuation: Actuation::RotorSpeeds(command_rad_s), ..Self::default() }
    }

    /// Thrust and torques in still air.
    pub fn wrench(wrench: Wrench) -> Self {
        Self { actuation: Actuation::Wrench(wrench), ..Self::default() }
    }
}
