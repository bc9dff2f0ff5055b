//! closed_loop_cost\[\]: every controller on every step, in one run.

use lmpc::{DesignError, Weighting};
use rayon::prelude::*;

use super::axis::{Axis, Step};
use super::clarabel_moves::ClarabelMoves;
use super::controllers::{Controller, End, clipped_regulator, finite_laguerre, laguerre, state_space};
use super::cost_result::{Contender, CostResult, entry};
use super::flight::fly;
use super::optimum::optimum;
use crate::error::Error;
use crate::progress::Progress;

/// a and α of the paper.
const PAPER_SCALE: f64 = 0.8187;
const PAPER_ALPHA: f64 = 1.2;

/// All controllers on all steps. The optima are found on all cores; the controllers fly on one, because they are
/// timed.
///
/// # Errors
/// [`Error::Design`] when a design that must exist does not, [`Error::Solver`].
pub fn closed_loop_cost(progress: &Progress) -> Result<Vec<CostResult>, Error> {
    let axes = Axis::all()?;
    let steps: Vec<(&Axis, &Step)> =
        axes.iter().flat_map(|axis| axis.steps.iter().map(move |step| (axis, step))).collect();
    let optima =
        steps.par_iter().map(|(axis, step)| optimum(axis, step)).collect::<Result<Vec<_>, Error>>()?;
    let mut results = Vec::new();
    for ((axis, step), optimum) in steps.iter().zip(optima) {
        for (contender, controller) in
            contenders(axis)?.into_iter().chain(state_space_contenders(axis, step)?)
        {
            let flown = controller.map(|controller| fly(axis, step, controller));
            results.push(CostResult::new(step.problem, contender, optimum, flown));
        }
        progress.advance();
    }
    Ok(results)
}

/// How often [`closed_loop_cost`] reports progress.
///
/// # Errors
/// As [`closed_loop_cost`].
pub fn closed_loop_cost_parts() -> Result<u64, Error> {
    Ok(Axis::all()?.iter().map(|axis| axis.steps.len() as u64).sum())
}

fn rounded(a: f64) -> f64 {
    (a * 1e4).round() / 1e4
}

type Entry = (Contender, Option<Controller>);

fn contenders(axis: &Axis) -> Result<Vec<Entry>, Error> {
    let mut entries = Vec::new();
    for n in [1, 3, 5, 7, 8, 9] {
        let name = format!("LMPC, N = {n}, a = {}", rounded(axis.scale()));
        entries.push(entry(name, n, laguerre(axis, n, axis.scale(), None))?);
    }
    // Without the stabilizing feedback, as the paper has it.
    for n in [5, 9] {
        let terminal = finite_laguerre(axis, n, axis.scale(), Weighting::Terminal { lambda: 1.0 });
        let name = format!("finite LMPC, N = {n}, a = {}, terminal weight", rounded(axis.scale()));
        entries.push(entry(name, n, terminal)?);
        let paper = finite_laguerre(axis, n, PAPER_SCALE, Weighting::exponential(PAPER_ALPHA, 1.0));
        let name = format!("finite LMPC, N = {n}, a = {PAPER_SCALE}, α = {PAPER_ALPHA}");
        entries.push(entry(name, n, paper)?);
    }
    entries.push(entry("DLQR, clipped".to_owned(), 0, clipped_regulator(axis))?);
    Ok(entries)
}

/// State-space MPC, as in (34) and with the regulator's cost as terminal weight; the latter solved by Clarabel, too, on
/// one step of each loop with a single input, because that takes hundreds of times as long.
fn state_space_contenders(axis: &Axis, step: &Step) -> Result<Vec<Entry>, Error> {
    let name = |n: usize| format!("SS-MPC, N_c = {n}");
    let weighted = |n: usize| format!("SS-MPC, N_c = {n}, terminal weight");
    let mut entries: Vec<Entry> = Vec::new();
    for n in [25, 50] {
        entries.push(entry(name(n), n, state_space(axis, n, End::Nothing))?);
        entries.push(entry(weighted(n), n, state_space(axis, n, End::Riccati))?);
    }
    if *step == axis.steps[1] && axis.linear.model.inputs() == 1 {
        let clarabel: Result<Controller, DesignError> = Ok(ClarabelMoves::new(axis, 25)?.controller());
        entries.push(entry(format!("{}, solved by Clarabel", weighted(25)), 25, clarabel)?);
    }
    Ok(entries)
}
