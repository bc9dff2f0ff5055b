//! What acts on the plant: u of f(x, u).

use nalgebra::Scalar;
use serde::{Deserialize, Serialize};

use crate::plant::differentiation::real::{Real, Valued};
use crate::plant::plant_state::zipped;
use crate::plant::rotor_fault::goals_rad_s;
use crate::{Disturbance, RotorFault, Wrench};

/// What drives the vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound(serialize = "T: Scalar + Serialize", deserialize = "T: Scalar + Deserialize<'de>"))]
pub enum Actuation<T = f64> {
    /// Commanded speeds of the rotors, rad/s, which follow with their lag.
    RotorSpeeds([T; 4]),
    /// Thrust and torques at once, in place of the rotors: their own speeds stay as they are, and neither their faults nor
    /// their spin, the air around them or the battery matter.
    Wrench(Wrench<T>),
}

/// All inputs of a [`Plant`](crate::Plant), constant over a step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound(serialize = "T: Scalar + Serialize", deserialize = "T: Scalar + Deserialize<'de>"))]
pub struct PlantInputs<T = f64> {
    /// What drives it.
    pub actuation: Actuation<T>,
    /// Wind, external force and torque.
    pub disturbance: Disturbance<T>,
    /// What is wrong with each rotor, in the order of the airframe's layout.
    pub rotor_faults: [Option<RotorFault>; 4],
    /// z of the ground below the vehicle, NED, m: zero on flat ground. It is level as far as the feet and the rotors reach. Without
    /// effect in a plant without ground.
    pub ground_z_m: T,
}

/// Rotors that are commanded to stand still.
impl<T: Real> Default for Actuation<T> {
    fn default() -> Self {
        Self::RotorSpeeds([T::zero(); 4])
    }
}

/// Rotors that are commanded to stand still, in still air over flat ground.
impl<T: Real> Default for PlantInputs<T> {
    fn default() -> Self {
        Self {
            actuation: Actuation::default(),
            disturbance: Disturbance::default(),
            rotor_faults: [None; 4],
            ground_z_m: T::zero(),
        }
    }
}

impl<T: Real> PlantInputs<T> {
    /// Commanded rotor speeds, rad/s, in still air.
    pub fn rotor_speeds(command_rad_s: [T; 4]) -> Self {
        Self { actuation: Actuation::RotorSpeeds(command_rad_s), ..Self::default() }
    }

    /// Thrust and torques in still air.
    pub fn wrench(wrench: Wrench<T>) -> Self {
        Self { actuation: Actuation::Wrench(wrench), ..Self::default() }
    }
}

impl<T: Valued> PlantInputs<T> {
    /// The inputs without their derivatives.
    pub(crate) fn values(&self) -> PlantInputs {
        self.zip_map(self, T::zero(), |number, _| number.value())
    }
}

impl PlantInputs {
    /// The speeds that the rotors go to, rad/s, at their present ones: as commanded, but for faults. Zero for a plant without rotors
    /// of its own, which is moved by thrust and torques.
    pub fn rotor_goals_rad_s(&self, present_rad_s: &[f64; 4]) -> [f64; 4] {
        match &self.actuation {
            Actuation::RotorSpeeds(command_rad_s) => {
                goals_rad_s(&self.rotor_faults, command_rad_s, present_rad_s)
            }
            Actuation::Wrench(_) => [0.0; 4],
        }
    }

    /// The name of the first input that is not finite.
    pub(crate) fn not_finite(&self) -> Option<&'static str> {
        let drive = match &self.actuation {
            Actuation::RotorSpeeds(command) if !command.iter().all(|speed| speed.is_finite()) => {
                Some("rotor.command")
            }
            Actuation::Wrench(wrench) if !wrench.thrust_n.is_finite() => Some("command.thrust"),
            Actuation::Wrench(wrench) if !wrench.torque_n_m.iter().all(|torque| torque.is_finite()) => {
                Some("command.torque")
            }
            _ => None,
        };
        let faults = || {
            let valid = self.rotor_faults.iter().flatten().all(|fault| fault.is_valid());
            (!valid).then_some("rotor_faults")
        };
        let ground = || (!self.ground_z_m.is_finite()).then_some("ground_z");
        drive.or_else(|| self.disturbance.not_finite()).or_else(faults).or_else(ground)
    }
}

impl<T: Scalar + Copy> PlantInputs<T> {
    /// Made of each of the numbers of both inputs, as long as the same drives both; otherwise of the numbers of `self` and
    /// `absent`. The faults are those of `self`.
    pub(crate) fn zip_map<U: Scalar + Copy, V: Scalar>(
        &self,
        other: &PlantInputs<U>,
        absent: U,
        f: impl Fn(T, U) -> V,
    ) -> PlantInputs<V> {
        let actuation = match (&self.actuation, &other.actuation) {
            (Actuation::RotorSpeeds(one), Actuation::RotorSpeeds(other)) => {
                Actuation::RotorSpeeds(zipped(one, other, &f))
            }
            (Actuation::Wrench(one), Actuation::Wrench(other)) => Actuation::Wrench(one.zip_map(other, &f)),
            (Actuation::RotorSpeeds(one), Actuation::Wrench(_)) => {
                Actuation::RotorSpeeds(zipped(one, &[absent; 4], &f))
            }
            (Actuation::Wrench(one), Actuation::RotorSpeeds(_)) => {
                Actuation::Wrench(one.zip_map(one, |t, _| f(t, absent)))
            }
        };
        PlantInputs {
            actuation,
            disturbance: self.disturbance.zip_map(&other.disturbance, &f),
            rotor_faults: self.rotor_faults,
            ground_z_m: f(self.ground_z_m, other.ground_z_m),
        }
    }
}
