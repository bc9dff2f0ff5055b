//! A step on two axes at once, with the joint tilt limited: the controllers of the size that the cascade has.

use std::f64::consts::PI;
use std::time::Instant;

use lmpc::{
    Augmented, Controller as _, ControllerState, DesignError, Discretization, LaguerreBasis, LaguerreMpc,
    Limit, LmpcDesign, Quantity, Sample, StateSpaceMpc, StateSpaceMpcDesign, Weighting, Weights, unknowns,
};
use nalgebra::{DMatrix, Vector2, Vector4};
use quadrotor::{GRAVITY_M_S2, position_model};

use super::axis::Axis;
use super::cost_result::{Contender, CostResult, entry};
use super::flight::Flown;
use crate::error::Error;

/// Sides of the polygon that stands for the joint limit of the two tilts.
const SIDES: usize = 16;
/// The step, m north and east.
const GOAL_M: [f64; 2] = [5.0, 5.0];
/// Samples flown.
const SAMPLES: usize = 600;
/// Free moves per input of the optimum.
const FREE_MOVES: usize = 80;

/// What a controller does with x and its increment: the two tilts, and how many iterations and active limits.
type Controller = Box<dyn FnMut(&Vector4<f64>, &Vector4<f64>) -> (Vector2<f64>, u32, usize)>;

/// LMPC and state-space MPC on the step, both of them with all inputs at once.
///
/// # Errors
/// As [`closed_loop_cost`](super::closed_loop_cost).
pub fn two_axes() -> Result<Vec<CostResult>, Error> {
    let [axis, ..] = Axis::all();
    let terminal = Weighting::Terminal { lambda: 1.0 };
    let all: Vec<usize> = (0..FREE_MOVES).collect();
    let optimum =
        fly(&axis, laguerre::<{ unknowns(2, FREE_MOVES) }>(&axis, FREE_MOVES, 0.0, terminal, &all)?).cost;
    let name = |n: usize| format!("LMPC, N = {n}, a = {}, terminal weight", axis.scale);
    let moves = |n: usize| format!("SS-MPC, N_c = {n}");
    let (scale, placing) = (axis.scale, axis.limited);
    let entries = [
        entry(name(1), 1, laguerre::<{ unknowns(2, 1) }>(&axis, 1, scale, terminal, placing))?,
        entry(name(3), 3, laguerre::<{ unknowns(2, 3) }>(&axis, 3, scale, terminal, placing))?,
        entry(name(5), 5, laguerre::<{ unknowns(2, 5) }>(&axis, 5, scale, terminal, placing))?,
        entry(name(7), 7, laguerre::<{ unknowns(2, 7) }>(&axis, 7, scale, terminal, placing))?,
        entry(name(9), 9, laguerre::<{ unknowns(2, 9) }>(&axis, 9, scale, terminal, placing))?,
        entry(moves(25), 25, state_space::<{ unknowns(2, 25) }>(&axis, 25))?,
        entry(moves(50), 50, state_space::<{ unknowns(2, 50) }>(&axis, 50))?,
    ];
    let problem = "position step of 5 m north and 5 m east";
    let result = |(contender, controller): (Contender, Option<Controller>)| {
        let flown = controller.map(|controller| fly(&axis, controller));
        CostResult::new(problem, contender, optimum, flown)
    };
    Ok(entries.into_iter().map(result).collect())
}

fn limits(axis: &Axis, samples: &[usize], moves: usize) -> ([Limit; 2], Vec<f64>) {
    let moving = samples.iter().copied().filter(|&sample| sample < moves);
    let limits = [
        Limit::polygon(Quantity::Input, SIDES, samples.iter().copied()),
        Limit::range(Quantity::Increment, 2, moving),
    ];
    let mut bounds = vec![axis.input[1] * (PI / SIDES as f64).cos(); SIDES];
    bounds.extend([axis.increment; 4]);
    (limits, bounds)
}

fn laguerre<const E: usize>(
    axis: &Axis,
    terms: usize,
    scale: f64,
    weighting: Weighting,
    placing: &[usize],
) -> Result<Controller, DesignError> {
    let model = Augmented::new(&position_model(axis.sample_time_s, Discretization::ZeroOrderHold)?);
    let weights = Weights::output(&model, axis.output_weight, axis.increment_weight)?;
    let bases = vec![LaguerreBasis::new(terms, scale)?; 2];
    let design = LmpcDesign::new(&model, &weights, &bases, axis.horizon, weighting)?;
    let moves = if scale == 0.0 { terms } else { usize::MAX };
    let (limits, bounds) = limits(axis, placing, moves);
    let controller = LaguerreMpc::<4, 2, 2, E>::new(&design, &limits)?;
    let mut state = ControllerState::<4, 2, E>::at_rest();
    Ok(Box::new(move |x, delta| {
        let sample =
            Sample { measured: *x, increment: *delta, error: error(x), upper: &bounds, ..Sample::default() };
        let result = controller.step(&mut state, &sample);
        (result.input, result.iterations, result.active)
    }))
}

fn state_space<const E: usize>(axis: &Axis, moves: usize) -> Result<Controller, DesignError> {
    let plant = position_model(axis.sample_time_s, Discretization::ZeroOrderHold)?;
    let identity = DMatrix::identity(2, 2);
    let (output, increment) = (&identity * axis.output_weight, &identity * axis.increment_weight);
    let design = StateSpaceMpcDesign::new(&plant, &output, &increment, axis.horizon, moves)?;
    let (limits, bounds) = limits(axis, axis.limited, moves);
    let controller = StateSpaceMpc::<4, 2, 2, E>::new(&design, &limits)?;
    let mut state = ControllerState::<4, 2, E>::at_rest();
    Ok(Box::new(move |x, _| {
        let deviation = x - Vector4::new(GOAL_M[0], 0.0, GOAL_M[1], 0.0);
        let result = controller.step(&mut state, &Sample { deviation, upper: &bounds, ..Sample::default() });
        (result.input, result.iterations, result.active)
    }))
}

fn error(x: &Vector4<f64>) -> Vector2<f64> {
    Vector2::new(x[0] - GOAL_M[0], x[2] - GOAL_M[1])
}

/// Flies the step.
fn fly(axis: &Axis, mut controller: Controller) -> Flown {
    let (mut x, mut delta, mut tilt) = (Vector4::zeros(), Vector4::zeros(), Vector2::zeros());
    let mut flown = Flown {
        cost: 0.0,
        times_us: Vec::with_capacity(SAMPLES),
        limited_us: Vec::new(),
        worst_iterations: 0,
        excess: 0.0,
        trace: Vec::new(),
    };
    for _ in 0..SAMPLES {
        let start = Instant::now();
        let (next, iterations, active) = controller(&x, &delta);
        let elapsed_us = start.elapsed().as_secs_f64() * 1e6;
        flown.times_us.push(elapsed_us);
        if active > 0 || iterations > 0 {
            flown.limited_us.push(elapsed_us);
        }
        flown.worst_iterations = flown.worst_iterations.max(iterations);
        let excess = (next.norm() / axis.input[1] - 1.0).max((next - tilt).amax() / axis.increment - 1.0);
        flown.excess = flown.excess.max(excess);
        flown.cost += axis.output_weight * error(&x).norm_squared()
            + axis.increment_weight * (next - tilt).norm_squared();
        let moved = advanced(axis.sample_time_s, &x, &next);
        (delta, x, tilt) = (moved - x, moved, next);
    }
    flown
}

/// ẍ = −g θ, ÿ = g φ over one sample.
fn advanced(time_s: f64, x: &Vector4<f64>, tilt: &Vector2<f64>) -> Vector4<f64> {
    let axis = |p: f64, v: f64, a: f64| (p + time_s * v + time_s * time_s / 2.0 * a, v + time_s * a);
    let (north, north_rate) = axis(x[0], x[1], -GRAVITY_M_S2 * tilt.x);
    let (east, east_rate) = axis(x[2], x[3], GRAVITY_M_S2 * tilt.y);
    Vector4::new(north, north_rate, east, east_rate)
}
