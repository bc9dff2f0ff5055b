//! What the plant is driven by.

use quadrotor::{Actuation, Disturbance, PlantInputs, RotorFault, Wrench};
use serde::{Deserialize, Serialize};

use super::settings::Drive;
use crate::tables::disturbances::Disturbed;
use crate::tables::ground::Grounded;

/// All inputs. What drives the vehicle is chosen by a parameter; the other command has no effect.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Commands {
    /// Commanded speeds of the rotors, rad/s.
    pub rotor_rad_s: [f64; 4],
    /// Thrust and torques at once.
    pub wrench: Wrench,
    /// Whether the motor of a rotor has no power.
    pub failed: [bool; 4],
    /// Wind, force and torque.
    pub disturbance: Disturbance,
    /// z of the ground below, NED, m.
    pub ground_z_m: f64,
}

/// A slow climb: 7.3 N for a weight of 6.9 N.
impl Default for Commands {
    fn default() -> Self {
        Self {
            rotor_rad_s: [260.0; 4],
            wrench: Wrench { thrust_n: 7.3, ..Wrench::default() },
            failed: [false; 4],
            disturbance: Disturbance::default(),
            ground_z_m: 0.0,
        }
    }
}

impl Disturbed for Commands {
    fn disturbance(&self) -> &Disturbance {
        &self.disturbance
    }

    fn disturbance_mut(&mut self) -> &mut Disturbance {
        &mut self.disturbance
    }
}

impl Grounded for Commands {
    fn ground_z_m(&self) -> f64 {
        self.ground_z_m
    }

    fn set_ground_z_m(&mut self, ground_z_m: f64) {
        self.ground_z_m = ground_z_m;
    }
}

impl Commands {
    /// What acts on the plant.
    pub(super) fn acting(&self, drive: Drive) -> PlantInputs {
        PlantInputs {
            actuation: match drive {
                Drive::RotorSpeeds => Actuation::RotorSpeeds(self.rotor_rad_s),
                Drive::Wrench => Actuation::Wrench(self.wrench),
            },
            disturbance: self.disturbance,
            rotor_faults: self.failed.map(|failed| failed.then_some(RotorFault::Off)),
            ground_z_m: self.ground_z_m,
        }
    }
}
