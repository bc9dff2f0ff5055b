//! The ground below the vehicle.

use fmi::Model;
use fmi::variables::{Field, Variable};
use quadrotor::Inputs;

use crate::quantities::POSITION;

/// Inputs with the height of the ground among them.
pub(crate) trait Grounded {
    /// z of the ground below the vehicle, NED, m.
    fn ground_z_m(&self) -> f64;
    /// Sets z of the ground below the vehicle, NED, m.
    fn set_ground_z_m(&mut self, ground_z_m: f64);
}

impl Grounded for Inputs {
    fn ground_z_m(&self) -> f64 {
        self.ground_z_m
    }

    fn set_ground_z_m(&mut self, ground_z_m: f64) {
        self.ground_z_m = ground_z_m;
    }
}

/// The height of the ground. It comes last in each table, so that no other variable's value reference has changed with it.
pub(crate) const fn ground<M: Model<Inputs: Grounded>>(description: &'static str) -> [Variable<M>; 1] {
    [Variable::input(
        "ground.z",
        description,
        Field::Real {
            quantity: &POSITION,
            minimum: -1e6,
            maximum: 1e6,
            get: |inputs: &M::Inputs| inputs.ground_z_m(),
            set: |inputs: &mut M::Inputs, value| inputs.set_ground_z_m(value),
        },
    )]
}

/// What the height of the ground means to a plant.
pub(crate) const OF_PLANT: &str = "z of the ground below the vehicle (positive down): -5 is a plateau 5 m above the origin; taken as level under feet and \
    rotors; no effect without environment.ground_plane";
