//! States, inputs and outputs that carry a derivative along one direction.

use super::dual::Dual;
use crate::{PlantInputs, PlantOutputs, PlantState};

impl PlantState {
    /// The state that changes by `seed`, a state as well: what is calculated from it carries the derivative in this direction.
    ///
    /// ```
    /// use quadrotor::{Airframe, Environment, InitialState, Plant, PlantInputs, PlantState};
    ///
    /// let airframe = Airframe { drag_n_s_m: [0.14; 3], ..Airframe::default() };
    /// let plant = Plant::new(&airframe, &Environment::default());
    /// let hover = PlantState::hovering(&InitialState::default(), &airframe);
    /// let inputs = PlantInputs::rotor_speeds(hover.rotor_speed_rad_s);
    /// // ∂f/∂v along north
    /// let mut seed = PlantState::from_array([0.0; PlantState::LEN]);
    /// seed.body.velocity_m_s.x = 1.0;
    /// let slope = plant.derivative(&hover.with_seed(&seed), &inputs.constant()).tangent();
    /// assert_eq!(slope.body.position_m.x, 1.0);
    /// assert!((slope.body.velocity_m_s.x + 0.14 / airframe.mass_kg).abs() < 1e-15);
    /// ```
    pub fn with_seed(&self, seed: &Self) -> PlantState<Dual> {
        self.zip_map(seed, Dual::new)
    }

    /// The state that does not change.
    pub fn constant(&self) -> PlantState<Dual> {
        self.zip_map(self, |value, _| Dual::new(value, 0.0))
    }
}

impl PlantState<Dual> {
    /// The state itself.
    pub fn value(&self) -> PlantState {
        self.zip_map(self, |number, _| number.value)
    }

    /// Its derivative.
    pub fn tangent(&self) -> PlantState {
        self.zip_map(self, |number, _| number.tangent)
    }
}

impl PlantInputs {
    /// The inputs that change by `seed`. What drives the vehicle does not change when the seed has the other
    /// [`Actuation`](crate::Actuation); rotor faults have no derivative.
    pub fn with_seed(&self, seed: &Self) -> PlantInputs<Dual> {
        self.zip_map(seed, 0.0, Dual::new)
    }

    /// The inputs that do not change.
    pub fn constant(&self) -> PlantInputs<Dual> {
        self.zip_map(self, 0.0, |value, _| Dual::new(value, 0.0))
    }
}

impl PlantOutputs<Dual> {
    /// The outputs themselves.
    pub fn value(&self) -> PlantOutputs {
        self.map(|number| number.value)
    }

    /// Their derivatives.
    pub fn tangent(&self) -> PlantOutputs {
        self.map(|number| number.tangent)
    }
}
