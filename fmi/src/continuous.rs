//! The equations of a model, for importers' own solvers and for derivatives.

use crate::error::CallError;
use crate::model::Model;
use crate::variables::{Role, Signal, Variable, variables};

/// A model as ordinary differential equations with events: ẋ = f(x, u), y = g(x, u).
///
/// The states are the outputs of which the table of variables has the time derivatives ([`Variable::derivative`]), in the
/// order of these derivatives. Between events the equations are smooth. At an event, which is where an indicator changes its
/// sign, the importer calls [`Continuous::update`].
pub trait Continuous<M: Model>: Sync {
    /// Number of event indicators.
    fn event_indicators(&self) -> usize;

    /// x, into a slice with one element a state.
    fn states(&self, model: &M, states: &mut [f64]);

    /// Sets x. All numbers are finite.
    fn set_states(&self, model: &mut M, states: &[f64]);

    /// ẋ = f(x, u)
    fn derivatives(&self, model: &M, inputs: &M::Inputs, derivatives: &mut [f64]);

    /// y = g(x, u), with the derivatives of the states among them.
    fn outputs(&self, model: &M, inputs: &M::Inputs) -> M::Outputs;

    /// The event indicators.
    fn indicators(&self, model: &M, inputs: &M::Inputs, indicators: &mut [f64]);

    /// Goes through an event: changes what is constant between events, and the states if they jump. Returns whether they did.
    fn update(&self, model: &mut M, inputs: &M::Inputs) -> bool;

    /// Whether a step of the solver has led to where an event is needed that no indicator announces.
    fn needs_event(&self, _model: &M) -> bool {
        false
    }

    /// Directional derivative of g at (x, u) along `seed`, exactly: dy = ∂g/∂x dx + ∂g/∂u du. Reading a variable from the result must give
    /// its derivative, so the table's functions that read outputs must be linear.
    fn tangent(&self, model: &M, inputs: &M::Inputs, seed: &Seed<M>) -> M::Outputs;

    /// The inputs and states that an output or a derivative depends on at the same instant. Each entry stands for all
    /// whose names begin with it.
    fn dependencies(&self, unknown: &str) -> &'static [&'static str];
}

/// A direction in the space of states and inputs.
pub struct Seed<M: Model> {
    /// dx
    pub states: Vec<f64>,
    /// du: the real inputs; the others mean nothing.
    pub inputs: M::Inputs,
}

/// A state of a model.
pub(crate) struct State {
    /// Its name: that of an output.
    pub name: &'static str,
    /// The name of its derivative.
    pub derivative: &'static str,
}

/// The states of a model in their order.
pub(crate) fn states<M: Model>() -> impl Iterator<Item = State> {
    variables::<M>().filter_map(|(_, variable)| match variable.role {
        Role::Derivative { of, .. } => Some(State { name: of, derivative: variable.name }),
        _ => None,
    })
}

/// Number of the states of a model.
pub(crate) fn state_count<M: Model>() -> usize {
    states::<M>().count()
}

/// Place of a variable among the states, if it is one.
pub(crate) fn state_place<M: Model>(variable: &Variable<M>) -> Option<usize> {
    let is_output = matches!(variable.role, Role::Output { .. });
    is_output.then(|| states::<M>().position(|state| state.name == variable.name)).flatten()
}

/// The equations of a model, if it has them.
pub(crate) fn equations<M: Model>() -> Result<&'static dyn Continuous<M>, CallError> {
    M::CONTINUOUS
        .ok_or(CallError::NotOffered("this model has no continuous states: it supports co-simulation only"))
}

/// How the value of an output or a derivative is read, if it is a real number.
pub(crate) fn real_signal<M: Model>(variable: &Variable<M>) -> Option<fn(&M::Outputs) -> f64> {
    match variable.role {
        Role::Output { signal: Signal::Real { get, .. }, .. } | Role::Derivative { get, .. } => Some(get),
        _ => None,
    }
}
