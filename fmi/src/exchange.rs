//! Model exchange: the importer's solver integrates the states.

use crate::continuous::{Continuous, State, equations, state_count, states};
use crate::error::CallError;
use crate::instance::Instance;
use crate::lifecycle::{Kind, Phase};
use crate::model::Model;
use crate::variables::named;

/// What follows from an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Event {
    /// Whether a state has jumped.
    pub states_changed: bool,
}

impl<M: Model> Instance<M> {
    pub fn enter_event_mode(&mut self) -> Result<(), CallError> {
        self.exchanged()?;
        self.set_phase(Phase::EventMode);
        Ok(())
    }

    pub fn enter_continuous_time_mode(&mut self) -> Result<(), CallError> {
        self.set_phase(Phase::ContinuousTimeMode);
        Ok(())
    }

    /// Goes through an event. One pass is enough: it leaves the model consistent.
    pub fn new_discrete_states(&mut self) -> Result<Event, CallError> {
        let equations = self.exchanged()?;
        let (model, inputs) = self.run()?;
        let states_changed = equations.update(model, inputs);
        self.forget_outputs();
        Ok(Event { states_changed })
    }

    /// Whether the importer shall enter event mode.
    pub fn completed_integrator_step(&mut self) -> Result<bool, CallError> {
        let equations = self.exchanged()?;
        let (model, _) = self.run()?;
        Ok(equations.needs_event(model))
    }

    /// Sets the states, one number each; none on an error.
    pub fn set_continuous_states(&mut self, given: &[f64]) -> Result<(), CallError> {
        let equations = self.exchanged_states(given.len())?;
        if let Some((state, value)) = not_finite::<M>(given) {
            return Err(CallError::StateNotFinite { name: state.name, value });
        }
        let (model, _) = self.run()?;
        equations.set_states(model, given);
        self.forget_outputs();
        Ok(())
    }

    /// The states.
    pub fn continuous_states(&mut self, into: &mut [f64]) -> Result<(), CallError> {
        let equations = self.exchanged_states(into.len())?;
        let (model, _) = self.run()?;
        equations.states(model, into);
        Ok(())
    }

    /// Typical magnitudes of the states.
    pub fn nominals_of_continuous_states(&self, into: &mut [f64]) -> Result<(), CallError> {
        self.exchanged_states(into.len())?;
        for (nominal, state) in into.iter_mut().zip(states::<M>()) {
            let quantity = named::<M>(state.name).and_then(|(_, variable)| variable.quantity());
            *nominal = quantity.map_or(1.0, |quantity| quantity.nominal);
        }
        Ok(())
    }

    /// The derivatives of the states. If one is not finite, the solver may try a shorter step.
    pub fn derivatives(&mut self, into: &mut [f64]) -> Result<(), CallError> {
        let equations = self.exchanged_states(into.len())?;
        let (model, inputs) = self.run()?;
        equations.derivatives(model, inputs, into);
        match not_finite::<M>(into) {
            Some((state, value)) => Err(CallError::NoDerivative { name: state.derivative, value }),
            None => Ok(()),
        }
    }

    /// The event indicators.
    pub fn event_indicators(&mut self, into: &mut [f64]) -> Result<(), CallError> {
        let equations = self.exchanged()?;
        same_count("ni", into.len(), equations.event_indicators())?;
        let (model, inputs) = self.run()?;
        equations.indicators(model, inputs, into);
        match into.iter().position(|value| !value.is_finite()) {
            Some(place) => Err(CallError::NoIndicator { place, value: into[place] }),
            None => Ok(()),
        }
    }

    /// Number of states.
    pub fn number_of_continuous_states(&self) -> Result<usize, CallError> {
        self.exchanged()?;
        Ok(state_count::<M>())
    }

    /// Number of event indicators.
    pub fn number_of_event_indicators(&self) -> Result<usize, CallError> {
        Ok(self.exchanged()?.event_indicators())
    }

    /// The event indicators as variables, which can be read however the run is driven.
    pub fn event_indicator_values(&mut self, into: &mut [f64]) -> Result<(), CallError> {
        let equations = equations::<M>()?;
        let (model, inputs) = self.run()?;
        equations.indicators(model, inputs, into);
        Ok(())
    }

    /// The equations, if this instance was made for model exchange.
    fn exchanged(&self) -> Result<&'static dyn Continuous<M>, CallError> {
        match self.kind() {
            Kind::ModelExchange => equations::<M>(),
            Kind::CoSimulation => Err(CallError::NotOffered(
                "this instance was made for co-simulation; instantiate it for model exchange",
            )),
        }
    }

    /// The same, if the importer passes as many numbers as there are states.
    fn exchanged_states(&self, count: usize) -> Result<&'static dyn Continuous<M>, CallError> {
        let equations = self.exchanged()?;
        same_count("nx", count, state_count::<M>())?;
        Ok(equations)
    }
}

/// The first of the states whose number is not finite.
fn not_finite<M: Model>(numbers: &[f64]) -> Option<(State, f64)> {
    let place = numbers.iter().position(|number| !number.is_finite())?;
    states::<M>().nth(place).map(|state| (state, numbers[place]))
}

/// The number of elements that an importer passes must be that of the model.
pub(crate) fn same_count(argument: &'static str, given: usize, expected: usize) -> Result<(), CallError> {
    if given == expected { Ok(()) } else { Err(CallError::Count { argument, given, expected }) }
}
