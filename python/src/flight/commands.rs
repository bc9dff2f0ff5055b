//! All inputs of a vehicle, whatever it is asked for.

use nalgebra::{UnitQuaternion, Vector3};
use quadrotor::{AttitudeTarget, Configuration, Inputs, PlantInputs, RotorFault};
use serde::{Deserialize, Serialize};

/// All inputs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Commands {
    /// Those of the closed loop.
    pub flight: Inputs,
    /// Commanded speeds of the rotors, rad/s.
    pub rotor_rad_s: [f64; 4],
    /// Body rates, FRD, rad/s.
    pub rate_rad_s: Vector3<f64>,
    /// Thrust, N.
    pub thrust_n: f64,
}

impl Commands {
    /// Those of the FMU, and thrust and rotor speeds that carry the weight.
    pub fn new(configuration: &Configuration) -> Self {
        let airframe = &configuration.airframe;
        Self {
            flight: Inputs::default(),
            rotor_rad_s: airframe.balanced_rotor_speeds_rad_s(),
            rate_rad_s: Vector3::zeros(),
            thrust_n: airframe.mass_kg * quadrotor::GRAVITY_M_S2,
        }
    }

    /// Whether the motor of a rotor has no power.
    pub fn has_failed(&self, rotor: usize) -> bool {
        self.flight.rotor_faults[rotor] == Some(RotorFault::Off)
    }

    /// Takes the power from the motor of a rotor, or gives it back.
    pub fn set_failed(&mut self, rotor: usize, failed: bool) {
        self.flight.rotor_faults[rotor] = failed.then_some(RotorFault::Off);
    }

    /// What acts on a plant that is driven by rotor speeds.
    pub fn of_plant(&self) -> PlantInputs {
        let command = if self.flight.armed { self.rotor_rad_s } else { [0.0; 4] };
        PlantInputs {
            disturbance: self.flight.disturbance,
            rotor_faults: if self.flight.armed { self.flight.rotor_faults } else { [None; 4] },
            ground_z_m: self.flight.ground_z_m,
            ..PlantInputs::rotor_speeds(command)
        }
    }

    /// Turning on from an attitude at the body rates, `elapsed_s` later.
    pub fn turning(&self, from: &UnitQuaternion<f64>, elapsed_s: f64) -> Inputs {
        let target = AttitudeTarget {
            attitude: from * UnitQuaternion::from_scaled_axis(self.rate_rad_s * elapsed_s),
            body_rate_rad_s: self.rate_rad_s,
            thrust_n: self.thrust_n,
        };
        Inputs { attitude_target: Some(target), ..self.flight }
    }
}
