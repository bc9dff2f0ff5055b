//! The claim in numbers: what a few Laguerre coefficients cost against one unknown per move.

use std::f64::consts::PI;
use std::time::Instant;

use lmpc::{
    Augmented, ConstrainedController, ConstrainedState, ControllerState, DesignError, Discretization,
    LaguerreBasis, Limit, LmpcDesign, Quantity, StateSpaceMpc, StateSpaceMpcDesign, StateSpaceMpcSample,
    Weighting, Weights,
};
use nalgebra::{DMatrix, Vector2, Vector4};
use quadrotor::{GRAVITY_M_S2, position_model};
use serde::Serialize;

/// ΔT, s.
const TIME: f64 = 0.05;
/// R on the tilt increments, per rad²; Q = CᵀC.
const WEIGHT: f64 = 1000.0;
/// N_p.
const HORIZON: usize = 100;
/// Samples that the limits are placed on.
const LIMITED: usize = 15;
/// Joint limit of the two tilts, rad, as a polygon of so many sides.
const TILT: f64 = 0.3;
const SIDES: usize = 16;
/// Limit of the increment of each tilt, rad.
const INCREMENT: f64 = 0.1;
/// The step, m.
const GOAL: [f64; 2] = [5.0, 5.0];
/// Samples flown.
const SAMPLES: usize = 600;

/// One controller on the constrained position step.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CostResult {
    /// The problem that was solved.
    pub problem: &'static str,
    /// The controller and its design choices.
    pub controller: String,
    /// Unknowns per input.
    pub n: usize,
    /// Σ |y − r|² + R |Δu|² of the whole flight.
    pub cost: f64,
    /// That over the cost of 60 free moves per input under limits on all of them.
    pub ratio_to_optimum: f64,
    /// Median time of a step, µs.
    pub median_us: f64,
    /// 99th percentile, µs.
    pub p99_us: f64,
    /// Most iterations of a step.
    pub worst_iterations: u32,
}

/// What a controller does with one sample: the two tilts, and how many iterations it took.
type Controller = Box<dyn FnMut(&Vector4<f64>, &Vector4<f64>) -> (Vector2<f64>, u32)>;

/// All controllers, in one run.
///
/// # Errors
/// [`DesignError`] when a design that must exist does not.
pub fn closed_loop_cost() -> Result<Vec<CostResult>, DesignError> {
    let terminal = Weighting::Terminal { lambda: 1.0 };
    let (optimum, ..) = flown(lmpc::<121>(60, 0.0, terminal, 60)?);
    let mut results = Vec::new();
    let mut add = |name: String, n: usize, controller: Controller| {
        let (cost, mut times, worst_iterations) = flown(controller);
        times.sort_by(f64::total_cmp);
        let at = |share: f64| times[(times.len() as f64 * share) as usize];
        results.push(CostResult {
            problem: "position step of 5 m north and 5 m east",
            controller: name,
            n,
            cost,
            ratio_to_optimum: cost / optimum,
            median_us: at(0.5),
            p99_us: at(0.99),
            worst_iterations,
        });
    };
    let named = |n: usize, scale: f64, recipe: &str| format!("LMPC, N = {n}, a = {scale}, {recipe}");
    let weight = "terminal weight";
    match lmpc::<3>(1, 0.9608, terminal, LIMITED) {
        Ok(controller) => add(named(1, 0.9608, weight), 1, controller),
        // One term may be too few to stabilise the loop: the design is refused, there is nothing to fly.
        Err(DesignError::Unstable { .. }) => {}
        Err(error) => return Err(error),
    }
    add(named(3, 0.9, weight), 3, lmpc::<7>(3, 0.9, terminal, LIMITED)?);
    add(named(5, 0.8187, weight), 5, lmpc::<11>(5, 0.8187, terminal, LIMITED)?);
    add(named(5, 0.85, weight), 5, lmpc::<11>(5, 0.85, terminal, LIMITED)?);
    add(named(7, 0.8, weight), 7, lmpc::<15>(7, 0.8, terminal, LIMITED)?);
    add(named(9, 0.75, weight), 9, lmpc::<19>(9, 0.75, terminal, LIMITED)?);
    let paper = Weighting::exponential(1.2, 1.0);
    add(named(5, 0.8187, "α = 1.2"), 5, lmpc::<11>(5, 0.8187, paper, LIMITED)?);
    add("SS-MPC, N_c = 25".to_owned(), 25, state_space::<51>(25)?);
    add("SS-MPC, N_c = 50".to_owned(), 50, state_space::<101>(50)?);
    Ok(results)
}

fn limits(samples: usize) -> [Limit; 2] {
    [Limit::polygon(Quantity::Input, SIDES, 0..samples), Limit::range(Quantity::Increment, 2, 0..samples)]
}

fn bounds() -> Vec<f64> {
    let mut bounds = vec![TILT * (PI / SIDES as f64).cos(); SIDES];
    bounds.extend([INCREMENT; 4]);
    bounds
}

fn lmpc<const E: usize>(
    terms: usize,
    scale: f64,
    weighting: Weighting,
    limited: usize,
) -> Result<Controller, DesignError> {
    let model = Augmented::new(&position_model(TIME, Discretization::ZeroOrderHold)?);
    let weights = Weights::output(&model, 1.0, WEIGHT)?;
    let bases = vec![LaguerreBasis::new(terms, scale)?; 2];
    let design = LmpcDesign::new(&model, &weights, &bases, HORIZON, weighting)?;
    let controller = ConstrainedController::<4, 2, 2, E>::new(&design, &limits(limited))?;
    let bounds = bounds();
    let mut state = ConstrainedState::<4, 2, E>::new(ControllerState::new(
        Vector4::zeros(),
        Vector2::zeros(),
        Vector2::zeros(),
    ));
    Ok(Box::new(move |x, delta| {
        let error = Vector2::new(x[0] - GOAL[0], x[2] - GOAL[1]);
        let result = controller.step_from(&mut state, x, delta, &error, &Vector2::zeros(), &bounds);
        (result.step.input, result.iterations)
    }))
}

fn state_space<const E: usize>(moves: usize) -> Result<Controller, DesignError> {
    let plant = position_model(TIME, Discretization::ZeroOrderHold)?;
    let identity = DMatrix::identity(2, 2);
    let design = StateSpaceMpcDesign::new(&plant, &identity, &(&identity * WEIGHT), HORIZON, moves)?;
    let controller = StateSpaceMpc::<4, 2, 2, E>::new(&design, &limits(LIMITED))?;
    let bounds = bounds();
    let mut state = ConstrainedState::<4, 2, E>::new(ControllerState::new(
        Vector4::zeros(),
        Vector2::zeros(),
        Vector2::zeros(),
    ));
    Ok(Box::new(move |x, _| {
        let sample = StateSpaceMpcSample::of_state(*x);
        let step = controller.step(&mut state, &sample, &[GOAL.into()], &bounds);
        (step.step.input, step.iterations)
    }))
}

/// Flies the step: cost, time of each step in µs, most iterations.
fn flown(mut controller: Controller) -> (f64, Vec<f64>, u32) {
    let (mut x, mut delta, mut u) = (Vector4::zeros(), Vector4::zeros(), Vector2::zeros());
    let (mut cost, mut worst) = (0.0, 0);
    let mut times = Vec::with_capacity(SAMPLES);
    for _ in 0..SAMPLES {
        let start = Instant::now();
        let (next, iterations) = controller(&x, &delta);
        times.push(start.elapsed().as_secs_f64() * 1e6);
        worst = worst.max(iterations);
        let error = Vector2::new(x[0] - GOAL[0], x[2] - GOAL[1]);
        cost += error.norm_squared() + WEIGHT * (next - u).norm_squared();
        let moved = advanced(&x, &next);
        (delta, x, u) = (moved - x, moved, next);
    }
    (cost, times, worst)
}

/// ẍ = −g θ, ÿ = g φ over one sample.
fn advanced(x: &Vector4<f64>, tilt: &Vector2<f64>) -> Vector4<f64> {
    let axis = |p: f64, v: f64, a: f64| (p + TIME * v + TIME * TIME / 2.0 * a, v + TIME * a);
    let (north, north_rate) = axis(x[0], x[1], -GRAVITY_M_S2 * tilt.x);
    let (east, east_rate) = axis(x[2], x[3], GRAVITY_M_S2 * tilt.y);
    Vector4::new(north, north_rate, east, east_rate)
}
