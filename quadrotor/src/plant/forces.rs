//! What acts on the plant, and what follows from it.

use nalgebra::Vector3;

use crate::plant::differentiation::real::Real;
use crate::plant::mass_properties::MassProperties;
use crate::{External, PlantState, Wrench};

/// All that acts on a plant in a state, but gravity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Forces<T> {
    /// Thrust and torques about the centre of mass of the rotors, or of what is in their place.
    pub(crate) wrench: Wrench<T>,
    /// The rest.
    pub(crate) external: External<T>,
    /// rad/s².
    pub(crate) rotor_acceleration_rad_s2: [T; 4],
    /// Share of the battery's charge that is drawn, 1/s.
    pub(crate) discharge_per_s: T,
}

impl<T: Real> Forces<T> {
    /// Of a vehicle that is driven by a wrench in place of its rotors, which stay as they are.
    pub(crate) fn without_rotors(wrench: Wrench<T>, external: External<T>) -> Self {
        Self { wrench, external, rotor_acceleration_rad_s2: [T::zero(); 4], discharge_per_s: T::zero() }
    }

    /// The time derivative of the state.
    #[inline(always)]
    pub(crate) fn derivative(&self, mass: &MassProperties, state: &PlantState<T>) -> PlantState<T> {
        PlantState {
            body: state.body.derivative_of(mass, &self.wrench, &self.external),
            rotor_speed_rad_s: self.rotor_acceleration_rad_s2,
            discharge: self.discharge_per_s,
        }
    }

    /// Acceleration of a vehicle with this state, NED, m/s².
    pub(crate) fn acceleration_m_s2(&self, mass: &MassProperties, state: &PlantState<T>) -> Vector3<T> {
        mass.acceleration_m_s2(&state.body, self.wrench.thrust_n, &self.external.force_n)
    }
}
