//! What the controllers take the vehicle for.

use nalgebra::Vector3;

use crate::Configuration;

/// Mass and drag that the controllers go by: as learned in flight, or as configured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Belief {
    /// Mass, kg.
    pub mass_kg: f64,
    /// Linear drag along north, east and down, N·s/m.
    pub drag_n_s_m: Vector3<f64>,
}

impl Belief {
    /// That of a configuration, with which learning begins.
    pub fn configured(configuration: &Configuration) -> Self {
        Self {
            mass_kg: configuration.believed_mass_kg(),
            drag_n_s_m: configuration.airframe.drag_n_s_m.into(),
        }
    }
}
