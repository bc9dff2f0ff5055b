//! The state of an instance: what `fmi2GetFMUstate` gives and `fmi2SetFMUstate` takes.

use quadrotor::{Configuration, Inputs, PARAMETERS, Simulation, SimulationState};
use serde::{Deserialize, Serialize};

use crate::clock::Clock;
use crate::error::{CallError, SavedStateError};
use crate::finite::is_finite;
use crate::input_derivative::{InputDerivative, MAXIMUM_ORDER, continuous};
use crate::lifecycle::State;

/// What the importer has set.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Settings {
    /// Parameters.
    pub configuration: Configuration,
    /// Inputs.
    pub inputs: Inputs,
}

/// Everything that changes in an instance, as plain data. The controllers follow from the configuration
/// and are designed again where they are needed; the logger belongs to the instance and stays with it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Snapshot {
    /// Where the instance is in its lifecycle.
    pub state: State,
    /// Its time base.
    pub clock: Clock,
    /// What the importer has set.
    pub settings: Settings,
    /// Derivatives of inputs for the next step.
    pub derivatives: Vec<InputDerivative>,
    /// The flight, if it has begun.
    pub simulation: Option<SimulationState>,
}

impl Snapshot {
    /// Refuses what no instance can have been in. A checksum does not protect against bytes that somebody
    /// made on purpose.
    pub fn check(&self) -> Result<(), CallError> {
        if !is_finite(self) {
            return Err(SavedStateError::NotFinite.into());
        }
        let contradiction = |what| Err(SavedStateError::Contradiction(what).into());
        if !self.clock.is_valid() {
            return contradiction("impossible times");
        }
        for parameter in PARAMETERS {
            parameter.check(&self.settings.configuration)?;
        }
        self.settings.check()?;
        for derivative in &self.derivatives {
            if !(1..=MAXIMUM_ORDER).contains(&derivative.order) || continuous(derivative.reference).is_none()
            {
                return contradiction("impossible derivatives of inputs");
            }
        }
        match (self.state, &self.simulation) {
            (State::Fatal, _) => contradiction("it is of a lost instance"),
            (State::Instantiated | State::Initialization, None) => Ok(()),
            (_, None) => contradiction("it has no flight"),
            (state, Some(flight)) => {
                let simulation = Simulation::from_state(&self.settings.configuration, *flight)?;
                // A failed step leaves the flight where it failed.
                if state != State::Error && simulation.time_us() != self.clock.time_us() {
                    return contradiction("the flight is at another time");
                }
                Ok(())
            }
        }
    }
}
