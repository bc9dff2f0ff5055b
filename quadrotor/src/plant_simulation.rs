//! The plant alone on the engine's schedule.

use serde::{Deserialize, Serialize};

use crate::configuration::validation::{validate_plant, validate_start_over};
use crate::control::instants::LATEST_US;
use crate::schedule::{next_look_us, next_point_us};
use crate::{
    Configuration, ConfigurationError, Plant, PlantInputs, PlantOutputs, PlantState, RigidBody,
    SimulationError,
};

/// A flight of a [`Plant`] under inputs from outside, on the grid of the closed loop's integration: driven by the commands that
/// a [`Simulation`](crate::Simulation) applied, at the times at which it applied them, it follows that flight bit for bit.
#[derive(Clone, Debug, PartialEq)]
pub struct PlantSimulation {
    plant: Plant,
    state: PlantSimulationState,
}

/// Everything that changes during a flight of a plant, and all there is to save and restore.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlantSimulationState {
    /// The present, µs after the start.
    time_us: u64,
    /// The last event, at or before the present: the plant's state is the one there.
    event_us: u64,
    plant: PlantState,
    /// What acts since the last event.
    inputs: PlantInputs,
}

impl PlantSimulation {
    /// A flight at time zero, from `start`.
    ///
    /// # Errors
    /// [`ConfigurationError`] when a value of the airframe, the environment or the start is out of range, or they contradict
    /// one another, or the start is below the ground of the inputs; whether controllers could fly it does not matter.
    pub fn new(
        configuration: &Configuration,
        start: &PlantState,
        inputs: &PlantInputs,
    ) -> Result<Self, ConfigurationError> {
        let state = PlantSimulationState { time_us: 0, event_us: 0, plant: *start, inputs: *inputs };
        let simulation = Self::from_state(configuration, state)?;
        validate_start_over(configuration, &start.body, inputs.ground_z_m)?;
        Ok(simulation)
    }

    /// A flight that goes on from a saved state of a flight with the same configuration.
    ///
    /// # Errors
    /// As [`PlantSimulation::new`], and [`ConfigurationError::State`].
    pub fn from_state(
        configuration: &Configuration,
        state: PlantSimulationState,
    ) -> Result<Self, ConfigurationError> {
        validate_plant(configuration)?;
        let plant = Plant::new(&configuration.airframe, &configuration.environment);
        state.check(&plant)?;
        Ok(Self { plant, state })
    }

    /// The plant.
    pub fn plant(&self) -> &Plant {
        &self.plant
    }

    /// The state, to be saved.
    pub fn state(&self) -> PlantSimulationState {
        self.state
    }

    /// Time since the start, µs.
    pub fn time_us(&self) -> u64 {
        self.state.time_us
    }

    /// What acts since the last event.
    pub fn inputs(&self) -> &PlantInputs {
        &self.state.inputs
    }

    /// The plant's state now.
    pub fn plant_state(&self) -> PlantState {
        self.plant_at(self.state.time_us)
    }

    /// The plant's state at `time_us`, not before the last event nor after the next.
    fn plant_at(&self, time_us: u64) -> PlantState {
        let PlantSimulationState { event_us, plant, inputs, .. } = &self.state;
        if time_us == *event_us {
            return *plant;
        }
        self.plant.step(plant, inputs, (time_us - event_us) as f64 / 1e6)
    }

    /// Puts the plant into another state, now.
    pub fn set_plant_state(&mut self, state: &PlantState) {
        self.state.event_us = self.state.time_us;
        self.state.plant = *state;
    }

    /// Changes the airframe during the flight, now: a payload is dropped by a change of its mass.
    ///
    /// # Errors
    /// As [`PlantSimulation::new`]; nothing has changed then.
    pub fn reconfigure(&mut self, configuration: &Configuration) -> Result<(), ConfigurationError> {
        validate_plant(configuration)?;
        // The motion until now was that of the old plant.
        self.set_plant_state(&self.plant_state());
        self.plant = Plant::new(&configuration.airframe, &configuration.environment);
        Ok(())
    }

    /// What can be observed now.
    pub fn outputs(&self) -> PlantOutputs {
        self.plant.outputs(&self.plant_state(), &self.state.inputs)
    }

    /// Flies on to `time_us`. Inputs are sampled now and at each whole millisecond; a change takes effect then.
    /// As long as they do not change between two of these, the flight does not depend on how the way there is split into calls.
    ///
    /// # Errors
    /// [`SimulationError`]; the flight then stands at the last event before it.
    pub fn advance_to(
        &mut self,
        time_us: u64,
        inputs: &impl Fn(u64) -> PlantInputs,
    ) -> Result<(), SimulationError> {
        if time_us < self.state.time_us {
            return Err(SimulationError::Backwards { time_us: self.state.time_us, requested_us: time_us });
        }
        while self.state.time_us < time_us {
            self.take(&inputs(self.state.time_us))?;
            let PlantSimulationState { event_us, plant, inputs, .. } = &self.state;
            let point_us = next_point_us(*event_us, &self.plant, (plant, inputs));
            let next_us = next_look_us(self.state.time_us).min(point_us);
            if next_us == point_us && next_us <= time_us {
                let plant = self.plant_at(next_us);
                if plant.has_diverged() {
                    let overload = self.state.inputs.disturbance.overload(self.plant.airframe());
                    return Err(SimulationError::Diverged { time_us: next_us, overload });
                }
                (self.state.event_us, self.state.plant) = (next_us, plant);
            }
            self.state.time_us = next_us.min(time_us);
        }
        Ok(())
    }

    /// Takes inputs that act from now on: if they differ, the motion until now was that of the old ones.
    fn take(&mut self, inputs: &PlantInputs) -> Result<(), SimulationError> {
        if let Some(name) = inputs.not_finite() {
            return Err(SimulationError::InputNotFinite { name, time_us: self.state.time_us });
        }
        if *inputs != self.state.inputs {
            self.set_plant_state(&self.plant_state());
            self.state.inputs = *inputs;
        }
        Ok(())
    }
}

impl PlantSimulationState {
    /// Whether a flight can have been in this state: saved states may come from anywhere.
    fn check(&self, of: &Plant) -> Result<(), ConfigurationError> {
        let wrong = |reason| Err(ConfigurationError::State { reason });
        let Self { time_us, event_us, plant, inputs } = self;
        if *time_us > LATEST_US || event_us > time_us {
            return wrong("its last event lies in the future");
        }
        if *time_us > next_point_us(*event_us, of, (plant, inputs)) {
            return wrong("its last event is not the last");
        }
        if plant.has_diverged() || !RigidBody::is_possible(&plant.body) {
            return wrong("its plant is not finite, or beyond what a vehicle can reach");
        }
        if inputs.not_finite().is_some() {
            return wrong("its inputs are not finite");
        }
        Ok(())
    }
}
