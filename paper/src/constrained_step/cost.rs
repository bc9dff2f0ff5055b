//! closed_loop_cost\[\]: every controller on every step, in one run.

use lmpc::{DesignError, Weighting, unknowns};
use rayon::prelude::*;

use super::axis::Axis;
use super::clarabel_moves::ClarabelMoves;
use super::controllers::{Controller, End, clipped_regulator, laguerre, state_space};
use super::cost_result::{Contender, CostResult, entry};
use super::flight::fly;
use super::optimum::optimum;
use super::two_axes::two_axes;
use crate::error::Error;
use crate::progress::Progress;

/// a and α of the paper.
pub(super) const PAPER_SCALE: f64 = 0.8187;
pub(super) const PAPER_ALPHA: f64 = 1.2;

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
