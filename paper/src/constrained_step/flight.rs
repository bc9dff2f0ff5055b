//! A step on the linear model of an axis.

use std::time::Instant;

use super::axis::Axis;
use super::controllers::{Controller, Sample};

/// Samples flown: until every controller here has settled.
pub const SAMPLES: usize = 1500;

/// A flown step.
#[derive(Clone, Debug, PartialEq)]
pub struct Flown {
    /// Σ q (y − r)² + q_rate Δẏ² + R Δu².
    pub cost: f64,
    /// Time of each sample, µs.
    pub times_us: Vec<f64>,
    /// The same of those samples on which the solver was needed.
    pub limited_us: Vec<f64>,
    /// Most iterations of a sample.
    pub worst_iterations: u32,
    /// Largest excess over a limit, as a share of it.
    pub excess: f64,
    /// y, ẏ and u at each sample.
    pub trace: Vec<[f64; 3]>,
}

/// Flies a step from rest at 0 to `goal`.
pub fn fly(axis: &Axis, goal: f64, mut controller: Controller) -> Flown {
    let time = axis.sample_time_s;
    let (mut y, mut rate, mut delta, mut input) = (0.0, 0.0, [0.0; 2], 0.0);
    let mut flown = Flown {
        cost: 0.0,
        times_us: Vec::with_capacity(SAMPLES),
        limited_us: Vec::new(),
        worst_iterations: 0,
        excess: 0.0,
        trace: Vec::with_capacity(SAMPLES),
    };
    for _ in 0..SAMPLES {
        let sample = Sample { state: [y, rate], delta, goal };
        let start = Instant::now();
        let moved = controller(&sample);
        let elapsed_us = start.elapsed().as_secs_f64() * 1e6;
        flown.times_us.push(elapsed_us);
        if moved.limited {
            flown.limited_us.push(elapsed_us);
        }
        flown.worst_iterations = flown.worst_iterations.max(moved.iterations);
        flown.excess = flown.excess.max(excess(axis, moved.input, moved.input - input, rate));
        flown.trace.push([y, rate, moved.input]);
        flown.cost += axis.output_weight * (y - goal).powi(2)
            + axis.rate_weight * delta[1].powi(2)
            + axis.increment_weight * (moved.input - input).powi(2);
        // Zero-order hold: exact for two integrators.
        let acceleration = axis.gain * moved.input;
        delta = [time * rate + time * time / 2.0 * acceleration, time * acceleration];
        (y, rate, input) = (y + delta[0], rate + delta[1], moved.input);
    }
    flown
}

/// By how much the worst limit is exceeded, as a share of it.
fn excess(axis: &Axis, input: f64, increment: f64, rate: f64) -> f64 {
    let beyond = |value: f64, [least, most]: [f64; 2]| {
        let share = |value: f64, limit: f64| if limit.is_finite() { value / limit - 1.0 } else { 0.0 };
        if value < 0.0 { share(value, least) } else { share(value, most) }
    };
    let increments = [-axis.increment, axis.increment];
    beyond(input, axis.input).max(beyond(increment, increments)).max(beyond(rate, axis.rate)).max(0.0)
}
