//! Plants with more states than they need.
//!
//! The controllers of `lmpc` have sizes that are known when they are compiled. A plant gets states beyond its own that are always
//! zero, up to a size that is there: nothing moves them and they do not show, so that the controller is the same.

use lmpc::{Limit, Quantity, SignalLimit, StateSpace, StateSpaceMpcWeights};
use nalgebra::DMatrix;

/// Eigenvalue of the states that are added: fast, and not zero, so that A can be inverted as before.
const DECAY: f64 = 0.01;

/// The plant with so many states.
pub fn plant(plant: &StateSpace, states: usize) -> Result<StateSpace, lmpc::DesignError> {
    let (inputs, outputs) = (plant.inputs(), plant.outputs());
    let mut a = plant.a().clone().resize(states, states, 0.0);
    for added in plant.states()..states {
        a[(added, added)] = DECAY;
    }
    StateSpace::new(
        a,
        plant.b().clone().resize(states, inputs, 0.0),
        plant.c().clone().resize(outputs, states, 0.0),
    )
}

/// The columns of a matrix over [Δx; y − r] of so many states, for more of them.
pub fn columns(matrix: &DMatrix<f64>, present: usize, states: usize) -> DMatrix<f64> {
    matrix.clone().insert_columns(present, states - present, 0.0)
}

/// A weight of [Δx; y − r] of so many states, for more of them.
pub fn weight(matrix: &DMatrix<f64>, present: usize, states: usize) -> DMatrix<f64> {
    columns(matrix, present, states).insert_rows(present, states - present, 0.0)
}

/// The weights of a state-space MPC for more states.
pub fn weights(weights: &StateSpaceMpcWeights, states: usize) -> StateSpaceMpcWeights {
    let present = weights.increment.nrows();
    StateSpaceMpcWeights {
        increment: weights.increment.clone().resize(states, states, 0.0),
        terminal: weights.terminal.as_ref().map(|terminal| weight(terminal, present, states)),
        ..weights.clone()
    }
}

/// Limits for more states.
pub fn limits(limits: &[Limit], states: usize) -> Vec<Limit> {
    let padded = |limit: &Limit| match limit.quantity {
        Quantity::State => {
            let directions = limit.directions.clone().resize_horizontally(states, 0.0);
            Limit { directions, ..limit.clone() }
        }
        Quantity::Increment | Quantity::Input => limit.clone(),
    };
    limits.iter().map(padded).collect()
}

/// Limits of signals for more states.
pub fn signal_limits(limits: &[SignalLimit], states: usize) -> Vec<SignalLimit> {
    let padded = |limit: &SignalLimit| SignalLimit {
        state: limit.state.clone().resize_horizontally(states, 0.0),
        ..limit.clone()
    };
    limits.iter().map(padded).collect()
}
