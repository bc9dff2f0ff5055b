//! A step on the linear model of a loop.

use std::time::Instant;

use nalgebra::DVector;

use super::axis::{Axis, Step};
use super::controllers::{Controller, Sample};

/// Samples flown: until every controller here has settled.
pub const SAMPLES: usize = 600;

/// A flown step.
#[derive(Clone, Debug, PartialEq)]
pub struct Flown {
    /// Σ \[Δx; y − r\]ᵀ Q \[Δx; y − r\] + Δuᵀ R Δu.
    pub cost: f64,
    /// Time of each sample, µs.
    pub times_us: Vec<f64>,
    /// The same of those samples on which the solver was needed.
    pub limited_us: Vec<f64>,
    /// Most iterations of a sample.
    pub worst_iterations: u32,
    /// Largest excess over a limit, as a share of it.
    pub excess: f64,
}

/// Flies a step.
pub fn fly(axis: &Axis, step: &Step, mut controller: Controller) -> Flown {
    let linear = &axis.linear;
    let (model, q, r) = (&linear.model, linear.weights.q(), linear.weights.r());
    let (states, inputs) = (model.states(), model.inputs());
    let goal = axis.at_rest(&step.goal);
    let mut state = DVector::zeros(states);
    let mut increment = DVector::zeros(states);
    let mut input = DVector::zeros(inputs);
    let mut flown = Flown {
        cost: 0.0,
        times_us: Vec::with_capacity(SAMPLES),
        limited_us: Vec::new(),
        worst_iterations: 0,
        excess: 0.0,
    };
    for _ in 0..SAMPLES {
        let error = model.c() * (&state - &goal);
        // A further set-point looks as if it were in sight, and so does the state's deviation from it.
        let seen = &error * (linear.sight / error.norm().max(linear.sight));
        let deviation = &state - axis.at_rest((model.c() * &state - &seen).as_slice());
        let sample = Sample { state: state.clone(), increment: increment.clone(), deviation, error: seen };
        let start = Instant::now();
        let moved = controller(&sample);
        let elapsed_us = start.elapsed().as_secs_f64() * 1e6;
        flown.times_us.push(elapsed_us);
        if moved.limited {
            flown.limited_us.push(elapsed_us);
        }
        flown.worst_iterations = flown.worst_iterations.max(moved.iterations);
        flown.excess = flown.excess.max(axis.excess(state.as_view(), moved.input.as_view()));
        let augmented = increment.clone().resize_vertically(states + error.len(), 0.0);
        let augmented = augmented + error.clone().insert_rows(0, states, 0.0);
        let change = &moved.input - &input;
        flown.cost += augmented.dot(&(q * &augmented)) + change.dot(&(r * &change));
        let next = model.a() * &state + model.b() * &moved.input;
        increment = &next - &state;
        (state, input) = (next, moved.input);
    }
    flown
}
