//! The state of an instance: what the importer saves and restores.

use serde::{Deserialize, Serialize};

use crate::choice_number::{ChosenNumber, are_consistent};
use crate::clock::Clock;
use crate::error::{CallError, SavedStateError};
use crate::finite::is_finite;
use crate::input_derivative::{InputDerivative, MAXIMUM_ORDER, continuous};
use crate::lifecycle::{Kind, Phase};
use crate::model::Model;
use crate::variables::{Role, variables};

/// What the importer has set.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Settings<P, I> {
    /// Parameters.
    pub parameters: P,
    /// Inputs.
    pub inputs: I,
    /// Enumerations among the parameters that were chosen by number.
    pub numbers: Vec<ChosenNumber>,
}

/// The settings of a model.
pub(crate) type SettingsOf<M> = Settings<<M as Model>::Parameters, <M as Model>::Inputs>;

/// Everything that changes in an instance, as plain data. What is computed from the parameters is computed again when it
/// is needed; the logger stays with the instance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub(crate) struct Snapshot<M: Model> {
    /// How the run is driven.
    pub kind: Kind,
    /// Phase of the instance.
    pub phase: Phase,
    /// Its time base.
    pub clock: Clock,
    /// What the importer has set.
    pub settings: SettingsOf<M>,
    /// Derivatives of inputs for the next step.
    pub derivatives: Vec<InputDerivative>,
    /// The run, if it has begun.
    pub run: Option<M::State>,
}

impl<M: Model> Snapshot<M> {
    /// Rejects a state that no instance can have been in. A checksum does not protect against forged bytes.
    pub fn check(&self) -> Result<(), CallError> {
        if !is_finite(self) {
            return Err(SavedStateError::NotFinite.into());
        }
        let inconsistent = |what| Err(SavedStateError::Inconsistent(what).into());
        if !self.clock.is_valid() {
            return inconsistent("invalid times");
        }
        self.check_settings()?;
        if !are_consistent::<M>(&self.settings) {
            return inconsistent("invalid numbers of enumerations");
        }
        for derivative in &self.derivatives {
            let is_continuous = continuous::<M>(derivative.reference).is_some();
            if !(1..=MAXIMUM_ORDER).contains(&derivative.order) || !is_continuous {
                return inconsistent("invalid input derivatives");
            }
        }
        let name = M::IDENTITY.words.run;
        let of_exchange = matches!(self.phase, Phase::EventMode | Phase::ContinuousTimeMode);
        let of_co_simulation = matches!(self.phase, Phase::StepComplete);
        match self.kind {
            Kind::CoSimulation if of_exchange => return inconsistent("a phase of model exchange"),
            Kind::ModelExchange if of_co_simulation || M::CONTINUOUS.is_none() => {
                return inconsistent("model exchange");
            }
            _ => {}
        }
        match (self.phase, &self.run) {
            (Phase::Fatal, _) => inconsistent("the instance had an internal error"),
            (Phase::Instantiated | Phase::Initialization, None) => Ok(()),
            (_, None) => Err(SavedStateError::NoRun { run: name }.into()),
            (phase, Some(state)) => {
                let model = M::from_state(&self.settings.parameters, state).map_err(CallError::of_model)?;
                // A failed step leaves the run where it failed.
                if self.kind == Kind::CoSimulation
                    && phase != Phase::Error
                    && model.time_us() != self.clock.time_us()
                {
                    return Err(SavedStateError::OtherTime { run: name }.into());
                }
                Ok(())
            }
        }
    }

    /// Rejects parameters and inputs that are out of range.
    fn check_settings(&self) -> Result<(), CallError> {
        for (_, variable) in variables::<M>() {
            match &variable.role {
                Role::Input(field) => variable.check_range(field.get(&self.settings.inputs))?,
                Role::Parameter { field, .. } => {
                    variable.check_range(field.get(&self.settings.parameters))?;
                }
                Role::Output { .. }
                | Role::Number { .. }
                | Role::Derivative { .. }
                | Role::CalculatedParameter { .. } => {}
            }
        }
        Ok(())
    }
}
