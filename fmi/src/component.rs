//! An instance of any model, as the shims see it: the one library of several models is compiled once for all of them.

use std::any::Any;

use crate::error::{CallError, SavedStateError};
use crate::exchange::Event;
use crate::instance::Instance;
use crate::lifecycle::Phase;
use crate::logger::Logger;
use crate::model::Model;
use crate::serialized::{deserialize, serialize};
use crate::snapshot::Snapshot;
use crate::variables::{Type, Value, ValueReference};

type Outcome = Result<(), CallError>;

/// An instance, whatever its model. A call that is rejected changes nothing, unless documented otherwise.
pub(crate) trait Component {
    /// Its phase.
    fn phase(&self) -> Phase;
    /// Marks it as unusable after a panic.
    fn abandon(&mut self);
    /// Its messages to the importer.
    fn logger(&mut self) -> &mut Logger;

    /// Sets the time base.
    fn setup_experiment(&mut self, start_s: f64, stop_s: Option<f64>) -> Outcome;
    /// Begins initialization.
    fn enter_initialization_mode(&mut self) -> Outcome;
    /// Ends initialization.
    fn exit_initialization_mode(&mut self) -> Outcome;
    /// Ends the run.
    fn terminate(&mut self) -> Outcome;
    /// Returns to the state after instantiation.
    fn reset(&mut self) -> Outcome;

    /// Values of variables of one type, each given to `put` with its place. Nothing is put unless all references are good.
    fn get(
        &mut self,
        asked: Type,
        references: &[ValueReference],
        put: &mut dyn FnMut(usize, Value),
    ) -> Outcome;
    /// Sets variables of one type to the values that `value` has for their places: all of them or none.
    fn set(&mut self, given: Type, references: &[ValueReference], value: &dyn Fn(usize) -> Value) -> Outcome;
    /// There are no String variables, so only an empty list of references is good.
    fn no_strings(&self, references: &[ValueReference]) -> Outcome;

    /// A copy of everything that changes.
    fn saved_state(&self) -> Box<dyn SavedState>;
    /// Restores a state of this instance or another one of the same model.
    fn restore(&mut self, state: &dyn SavedState) -> Outcome;
    /// The state that was serialized, checked.
    fn deserialize(&self, bytes: &[u8]) -> Result<Box<dyn SavedState>, CallError>;

    /// Derivatives of inputs for the next step.
    fn set_input_derivatives(
        &mut self,
        references: &[ValueReference],
        orders: &[i32],
        values: &[f64],
    ) -> Outcome;
    /// Advances from one communication point to the next.
    fn do_step(&mut self, point_s: f64, step_s: f64) -> Outcome;
    /// Derivatives of `unknowns` along `direction` in `knowns`.
    fn directional_derivative(
        &mut self,
        unknowns: &[ValueReference],
        knowns: &[ValueReference],
        direction: &[f64],
        into: &mut [f64],
    ) -> Outcome;
    /// Derivatives of the weighted sum of `unknowns` with respect to each of `knowns`.
    fn adjoint_derivative(
        &mut self,
        unknowns: &[ValueReference],
        knowns: &[ValueReference],
        weights: &[f64],
        into: &mut [f64],
    ) -> Outcome;
    /// Time derivatives of outputs.
    fn output_derivatives(
        &mut self,
        references: &[ValueReference],
        orders: &[i32],
        into: &mut [f64],
    ) -> Outcome;

    /// Model exchange: sets the time.
    fn set_time(&mut self, time_s: f64) -> Outcome;
    /// Model exchange: begins an event.
    fn enter_event_mode(&mut self) -> Outcome;
    /// Model exchange: goes on behind an event.
    fn enter_continuous_time_mode(&mut self) -> Outcome;
    /// Model exchange: goes through an event.
    fn new_discrete_states(&mut self) -> Result<Event, CallError>;
    /// Model exchange: whether the importer shall enter event mode.
    fn completed_integrator_step(&mut self) -> Result<bool, CallError>;
    /// Model exchange: sets the states.
    fn set_continuous_states(&mut self, given: &[f64]) -> Outcome;
    /// Model exchange: the states.
    fn continuous_states(&mut self, into: &mut [f64]) -> Outcome;
    /// Model exchange: typical magnitudes of the states.
    fn nominals_of_continuous_states(&self, into: &mut [f64]) -> Outcome;
    /// Model exchange: the derivatives of the states.
    fn derivatives(&mut self, into: &mut [f64]) -> Outcome;
    /// Model exchange: the event indicators.
    fn event_indicators(&mut self, into: &mut [f64]) -> Outcome;

    /// Model exchange: number of states.
    fn number_of_continuous_states(&self) -> Result<usize, CallError>;
    /// Model exchange: number of event indicators.
    fn number_of_event_indicators(&self) -> Result<usize, CallError>;
    /// The event indicators as variables.
    fn event_indicator_values(&mut self, into: &mut [f64]) -> Outcome;

    /// Whether the last step was rejected or failed.
    fn last_step_failed(&self) -> bool;
    /// The current time, s.
    fn time_s(&self) -> f64;
}

/// The state of an instance, whatever its model.
pub(crate) trait SavedState: Any {
    /// As bytes.
    fn bytes(&self) -> Result<Vec<u8>, CallError>;
}

/// Copies the bytes of a state to a buffer of exactly their size.
pub(crate) fn write_bytes(state: &dyn SavedState, buffer: &mut [u8]) -> Result<(), CallError> {
    let bytes = state.bytes()?;
    if bytes.len() != buffer.len() {
        return Err(SavedStateError::Length { actual: buffer.len(), expected: bytes.len() }.into());
    }
    buffer.copy_from_slice(&bytes);
    Ok(())
}

impl<M: Model> SavedState for Snapshot<M> {
    fn bytes(&self) -> Result<Vec<u8>, CallError> {
        serialize(self)
    }
}

impl<M: Model> Component for Instance<M> {
    fn phase(&self) -> Phase {
        self.phase()
    }

    fn abandon(&mut self) {
        self.abandon();
    }

    fn logger(&mut self) -> &mut Logger {
        &mut self.logger
    }

    fn setup_experiment(&mut self, start_s: f64, stop_s: Option<f64>) -> Outcome {
        self.setup_experiment(start_s, stop_s)
    }

    fn enter_initialization_mode(&mut self) -> Outcome {
        self.enter_initialization_mode()
    }

    fn exit_initialization_mode(&mut self) -> Outcome {
        self.exit_initialization_mode()
    }

    fn terminate(&mut self) -> Outcome {
        self.terminate()
    }

    fn reset(&mut self) -> Outcome {
        self.reset()
    }

    fn get(
        &mut self,
        asked: Type,
        references: &[ValueReference],
        put: &mut dyn FnMut(usize, Value),
    ) -> Outcome {
        self.get(asked, references, put)
    }

    fn set(&mut self, given: Type, references: &[ValueReference], value: &dyn Fn(usize) -> Value) -> Outcome {
        self.set(given, references, value)
    }

    fn no_strings(&self, references: &[ValueReference]) -> Outcome {
        self.no_strings(references)
    }

    fn saved_state(&self) -> Box<dyn SavedState> {
        Box::new(self.snapshot())
    }

    fn restore(&mut self, state: &dyn SavedState) -> Outcome {
        let state: &dyn Any = state;
        match state.downcast_ref::<Snapshot<M>>() {
            Some(state) => self.restore(state),
            None => Err(SavedStateError::OtherModel.into()),
        }
    }

    fn deserialize(&self, bytes: &[u8]) -> Result<Box<dyn SavedState>, CallError> {
        Ok(Box::new(deserialize::<M>(bytes)?))
    }

    fn set_input_derivatives(
        &mut self,
        references: &[ValueReference],
        orders: &[i32],
        values: &[f64],
    ) -> Outcome {
        self.set_input_derivatives(references, orders, values)
    }

    fn do_step(&mut self, point_s: f64, step_s: f64) -> Outcome {
        self.do_step(point_s, step_s)
    }

    fn directional_derivative(
        &mut self,
        unknowns: &[ValueReference],
        knowns: &[ValueReference],
        direction: &[f64],
        into: &mut [f64],
    ) -> Outcome {
        self.directional_derivative(unknowns, knowns, direction, into)
    }

    fn adjoint_derivative(
        &mut self,
        unknowns: &[ValueReference],
        knowns: &[ValueReference],
        weights: &[f64],
        into: &mut [f64],
    ) -> Outcome {
        self.adjoint_derivative(unknowns, knowns, weights, into)
    }

    fn output_derivatives(
        &mut self,
        references: &[ValueReference],
        orders: &[i32],
        into: &mut [f64],
    ) -> Outcome {
        self.output_derivatives(references, orders, into)
    }

    fn set_time(&mut self, time_s: f64) -> Outcome {
        self.set_time(time_s)
    }

    fn enter_event_mode(&mut self) -> Outcome {
        self.enter_event_mode()
    }

    fn enter_continuous_time_mode(&mut self) -> Outcome {
        self.enter_continuous_time_mode()
    }

    fn new_discrete_states(&mut self) -> Result<Event, CallError> {
        self.new_discrete_states()
    }

    fn completed_integrator_step(&mut self) -> Result<bool, CallError> {
        self.completed_integrator_step()
    }

    fn set_continuous_states(&mut self, given: &[f64]) -> Outcome {
        self.set_continuous_states(given)
    }

    fn continuous_states(&mut self, into: &mut [f64]) -> Outcome {
        self.continuous_states(into)
    }

    fn nominals_of_continuous_states(&self, into: &mut [f64]) -> Outcome {
        self.nominals_of_continuous_states(into)
    }

    fn derivatives(&mut self, into: &mut [f64]) -> Outcome {
        self.derivatives(into)
    }

    fn event_indicators(&mut self, into: &mut [f64]) -> Outcome {
        self.event_indicators(into)
    }

    fn number_of_continuous_states(&self) -> Result<usize, CallError> {
        self.number_of_continuous_states()
    }

    fn number_of_event_indicators(&self) -> Result<usize, CallError> {
        self.number_of_event_indicators()
    }

    fn event_indicator_values(&mut self, into: &mut [f64]) -> Outcome {
        self.event_indicator_values(into)
    }

    fn last_step_failed(&self) -> bool {
        self.last_step_failed()
    }

    fn time_s(&self) -> f64 {
        self.time_s()
    }
}
