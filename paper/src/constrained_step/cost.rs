//! closed_loop_cost\[\]: every controller on every step, in one run.

use lmpc::{DesignError, Weighting, unknowns};
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use super::axis::Axis;
use super::clarabel_moves::ClarabelMoves;
use super::controllers::{Controller, End, clipped_regulator, laguerre, state_space};
use super::flight::{Flown, fly};
use super::optimum::optimum;
use super::two_axes::two_axes;
use crate::error::Error;
use crate::progress::Progress;

/// a and α of the paper.
pub(super) const PAPER_SCALE: f64 = 0.8187;
pub(super) const PAPER_ALPHA: f64 = 1.2;

/// One controller on one step under limits.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct CostResult {
    /// The step.
    pub problem: String,
    /// The controller and its design choices.
    pub controller: String,
    /// Unknowns per input: N of LMPC, N_c of state-space MPC, 0 of the regulator.
    pub n: usize,
    /// Σ q (y − r)² + q_rate Δẏ² + R Δu² of the whole step; null where the design was refused.
    pub cost: Option<f64>,
    /// That over the least cost of the same step under all limits at all samples.
    pub ratio_to_optimum: Option<f64>,
    /// Largest excess over a limit during the step, as a share of the limit. A controller that exceeds one may
    /// cost less than the optimum.
    pub worst_excess: Option<f64>,
    /// Median time of a sample, µs.
    pub median_us: Option<f64>,
    /// 99th percentile of the same, µs.
    pub p99_us: Option<f64>,
    /// Median time of those samples at which limits were active, µs; null when there were none.
    pub median_limited_us: Option<f64>,
    /// Most iterations of a sample.
    pub worst_iterations: Option<u32>,
    /// Why the design was refused.
    pub refused: Option<String>,
}

impl CostResult {
    pub(super) fn new(problem: &str, contender: Contender, optimum: f64, outcome: Option<Flown>) -> Self {
        let quantile = |times: &[f64], share: f64| {
            let mut times = times.to_vec();
            times.sort_by(f64::total_cmp);
            times.get((times.len() as f64 * share) as usize).copied()
        };
        let flown = outcome.as_ref();
        Self {
            problem: problem.to_owned(),
            controller: contender.name,
            n: contender.n,
            cost: flown.map(|flown| flown.cost),
            ratio_to_optimum: flown.map(|flown| flown.cost / optimum),
            worst_excess: flown.map(|flown| flown.excess),
            median_us: flown.and_then(|flown| quantile(&flown.times_us, 0.5)),
            p99_us: flown.and_then(|flown| quantile(&flown.times_us, 0.99)),
            median_limited_us: flown.and_then(|flown| quantile(&flown.limited_us, 0.5)),
            worst_iterations: flown.map(|flown| flown.worst_iterations),
            refused: contender.refused,
        }
    }
}

/// Who flies.
pub(super) struct Contender {
    pub name: String,
    pub n: usize,
    pub refused: Option<String>,
}

/// All controllers on all steps. The optima are found on all cores; the controllers fly on one, because they are
/// timed.
///
/// # Errors
/// [`Error::Design`] when a design that must exist does not, [`Error::Solver`].
pub fn closed_loop_cost(progress: &Progress) -> Result<Vec<CostResult>, Error> {
    let axes = Axis::all();
    let steps: Vec<(&Axis, f64)> =
        axes.iter().flat_map(|axis| axis.steps.iter().map(move |&step| (axis, step))).collect();
    let optima =
        steps.par_iter().map(|(axis, step)| optimum(axis, *step)).collect::<Result<Vec<_>, Error>>()?;
    let mut results = Vec::new();
    for ((axis, step), optimum) in steps.iter().zip(optima) {
        let problem = axis.problem(*step);
        for (contender, controller) in
            contenders(axis)?.into_iter().chain(state_space_contenders(axis, *step)?)
        {
            let flown = controller.map(|controller| fly(axis, *step, controller));
            results.push(CostResult::new(&problem, contender, optimum, flown));
        }
        progress.advance();
    }
    results.extend(two_axes()?);
    progress.advance();
    Ok(results)
}

/// How often [`closed_loop_cost`] reports progress.
pub fn closed_loop_cost_parts() -> u64 {
    Axis::all().iter().map(|axis| axis.steps.len() as u64).sum::<u64>() + 1
}

type Entry = (Contender, Option<Controller>);

fn contenders(axis: &Axis) -> Result<Vec<Entry>, Error> {
    let (scale, placing) = (axis.scale, axis.limited);
    let terminal = Weighting::Terminal { lambda: 1.0 };
    let paper = Weighting::exponential(PAPER_ALPHA, 1.0);
    let name = |n: usize, scale: f64, recipe: &str| format!("LMPC, N = {n}, a = {scale}, {recipe}");
    let own = |n: usize, controller: Result<Controller, DesignError>| {
        entry(name(n, scale, "terminal weight"), n, controller)
    };
    let papers = |n: usize, controller: Result<Controller, DesignError>| {
        entry(name(n, PAPER_SCALE, "α = 1.2"), n, controller)
    };
    Ok(vec![
        own(1, laguerre::<{ unknowns(1, 1) }>(axis, 1, scale, terminal, placing))?,
        own(3, laguerre::<{ unknowns(1, 3) }>(axis, 3, scale, terminal, placing))?,
        own(5, laguerre::<{ unknowns(1, 5) }>(axis, 5, scale, terminal, placing))?,
        own(7, laguerre::<{ unknowns(1, 7) }>(axis, 7, scale, terminal, placing))?,
        own(9, laguerre::<{ unknowns(1, 9) }>(axis, 9, scale, terminal, placing))?,
        papers(5, laguerre::<{ unknowns(1, 5) }>(axis, 5, PAPER_SCALE, paper, placing))?,
        papers(9, laguerre::<{ unknowns(1, 9) }>(axis, 9, PAPER_SCALE, paper, placing))?,
        entry("DLQR, clipped".to_owned(), 0, clipped_regulator(axis))?,
    ])
}

/// State-space MPC over the same horizon as LMPC, as in (34) and with the terminal weight that LMPC has; the latter
/// solved by Clarabel, too, on one step of each axis, because that takes hundreds of times as long.
fn state_space_contenders(axis: &Axis, step: f64) -> Result<Vec<Entry>, Error> {
    let placing = axis.limited;
    let name = |n: usize| format!("SS-MPC, N_c = {n}");
    let weighted = |n: usize| format!("SS-MPC, N_c = {n}, terminal weight");
    let mut entries = vec![
        entry(name(25), 25, state_space::<{ unknowns(1, 25) }>(axis, 25, End::Nothing, placing))?,
        entry(name(50), 50, state_space::<{ unknowns(1, 50) }>(axis, 50, End::Nothing, placing))?,
        entry(weighted(25), 25, state_space::<{ unknowns(1, 25) }>(axis, 25, End::Riccati, placing))?,
        entry(weighted(50), 50, state_space::<{ unknowns(1, 50) }>(axis, 50, End::Riccati, placing))?,
    ];
    if step.abs() == axis.steps[1].abs() {
        let clarabel = ClarabelMoves::new(axis, 25, placing)?.controller();
        entries.push(entry(format!("{}, solved by Clarabel", weighted(25)), 25, Ok(clarabel))?);
    }
    Ok(entries)
}

/// A design that is not stable is a result; any other refusal is a mistake.
pub(super) fn entry<T>(
    name: String,
    n: usize,
    controller: Result<T, DesignError>,
) -> Result<(Contender, Option<T>), Error> {
    match controller {
        Ok(controller) => Ok((Contender { name, n, refused: None }, Some(controller))),
        Err(error @ DesignError::Unstable { .. }) => {
            Ok((Contender { name, n, refused: Some(error.to_string()) }, None))
        }
        Err(error) => Err(error.into()),
    }
}
