//! What N, a, α and the placing of limits cost: the excess over the optimum, for whole grids of designs.

use lmpc::{DesignError, Weighting};
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use super::axis::Axis;
use super::controllers::{finite_laguerre, laguerre};
use super::flight::fly;
use super::optimum::optimum;
use crate::error::Error;
use crate::progress::Progress;

/// N of the grids.
pub const TERMS: [usize; 10] = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10];
/// a of the grids.
pub const SCALES: [f64; 14] = [0.0, 0.3, 0.5, 0.6, 0.65, 0.7, 0.75, 0.8, 0.8187, 0.86, 0.9, 0.93, 0.96, 0.98];
/// α of the grids, for the paper's program over a finite horizon; 1 stands for the terminal weight.
pub const ALPHAS: [f64; 9] = [1.0, 1.01, 1.02, 1.05, 1.08, 1.1, 1.15, 1.2, 1.3];
/// By how much a differs in the grid beside the defaults.
pub const SCALE_OFFSETS: [f64; 3] = [-0.05, 0.0, 0.05];
/// Last sample of the contiguous placings.
pub const LAST: [usize; 9] = [0, 2, 4, 9, 14, 19, 29, 44, 59];
/// N of the lines over placings.
pub const PLACED_TERMS: [usize; 4] = [3, 5, 7, 9];

/// One design on all steps of its axis.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct ExcessCost {
    /// "position", "altitude", "roll" or "yaw".
    pub axis: &'static str,
    /// What varies: "N and a", "beside the default", "placing", or "α and a" of the paper's program over a finite horizon.
    pub grid: &'static str,
    /// N.
    pub n: usize,
    /// a.
    pub a: f64,
    /// α; 1 stands for the terminal weight.
    pub alpha: f64,
    /// Samples that all limits are placed on; null for those that fly, which differ from limit to limit.
    pub limited: Option<Vec<usize>>,
    /// Largest cost over the optimum, of all steps of the axis, %; null where the design was refused.
    pub worst_excess_percent: Option<f64>,
    /// By how much a limit was exceeded at worst, as a share of it.
    pub worst_limit_excess: Option<f64>,
}

/// The grids.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct TradeOff {
    /// Every design.
    pub designs: Vec<ExcessCost>,
}

impl TradeOff {
    /// The designs of a grid on one loop.
    pub fn grid<'a>(&'a self, axis: &'a str, grid: &'a str) -> impl Iterator<Item = &'a ExcessCost> {
        self.designs.iter().filter(move |design| design.axis == axis && design.grid == grid)
    }

    /// The default design of a loop.
    pub fn default_of<'a>(&'a self, axis: &'a str) -> Option<&'a ExcessCost> {
        // In the middle of its neighbours.
        self.grid(axis, "beside the default").nth(SCALE_OFFSETS.len() + SCALE_OFFSETS.len() / 2)
    }
}

/// The whole grid, on all cores.
///
/// # Errors
/// As [`closed_loop_cost`](super::closed_loop_cost).
pub fn trade_off(progress: &Progress) -> Result<TradeOff, Error> {
    let axes = Axis::all()?;
    let optima = axes
        .par_iter()
        .map(|axis| axis.steps.iter().map(|step| optimum(axis, step)).collect())
        .collect::<Result<Vec<Vec<f64>>, Error>>()?;
    let tasks: Vec<(&Axis, &[f64], Choice)> = axes
        .iter()
        .zip(&optima)
        .flat_map(|(axis, optima)| choices(axis).into_iter().map(move |choice| (axis, &optima[..], choice)))
        .collect();
    let designs = tasks
        .into_par_iter()
        .map(|(axis, optima, choice)| {
            let result = flown(axis, optima, choice);
            progress.advance();
            result
        })
        .collect::<Result<Vec<_>, Error>>()?;
    Ok(TradeOff { designs })
}

/// How often [`trade_off`] reports progress.
///
/// # Errors
/// As [`trade_off`].
pub fn trade_off_parts() -> Result<u64, Error> {
    Ok(Axis::all()?.iter().map(|axis| choices(axis).len() as u64).sum())
}

#[derive(Clone)]
struct Choice {
    grid: &'static str,
    n: usize,
    a: f64,
    alpha: f64,
    limited: Option<Vec<usize>>,
}

fn choices(axis: &Axis) -> Vec<Choice> {
    let own = |grid, n, a, alpha| Choice { grid, n, a, alpha, limited: None };
    let mut choices = Vec::new();
    for a in SCALES {
        choices.extend(TERMS.map(|n| own("N and a", n, a, 1.0)));
        choices.extend(ALPHAS.map(|alpha| own(FINITE, 5, a, alpha)));
    }
    let default = axis.linear.terms;
    for n in [default - 1, default, default + 1] {
        choices.extend(SCALE_OFFSETS.map(|offset| own("beside the default", n, axis.scale() + offset, 1.0)));
    }
    for n in PLACED_TERMS {
        let placed = |limited| Choice { limited, ..own("placing", n, axis.scale(), 1.0) };
        choices.extend(LAST.map(|last| placed(Some((0..=last).collect()))));
        choices.push(placed(None));
    }
    choices
}

/// The grid of the paper's program.
const FINITE: &str = "α and a";

fn flown(axis: &Axis, optima: &[f64], choice: Choice) -> Result<ExcessCost, Error> {
    let Choice { grid, n, a, alpha, limited } = choice;
    let weighting =
        if alpha > 1.0 { Weighting::exponential(alpha, 1.0) } else { Weighting::Terminal { lambda: 1.0 } };
    let mut result = ExcessCost {
        axis: axis.name,
        grid,
        n,
        a,
        alpha,
        limited,
        worst_excess_percent: None,
        worst_limit_excess: None,
    };
    for (step, optimum) in axis.steps.iter().zip(optima) {
        let designed = if grid == FINITE {
            finite_laguerre(axis, n, a, weighting)
        } else {
            laguerre(axis, n, a, result.limited.as_deref())
        };
        let controller = match designed {
            Ok(controller) => controller,
            Err(
                DesignError::Unstable { .. }
                | DesignError::IllConditioned { .. }
                | DesignError::LaguerreScale { .. },
            ) => break,
            Err(error) => return Err(error.into()),
        };
        let flown = fly(axis, step, controller);
        let percent = 100.0 * (flown.cost / optimum - 1.0);
        let worst = |before: Option<f64>, now: f64| Some(before.map_or(now, |before| before.max(now)));
        result.worst_excess_percent = worst(result.worst_excess_percent, percent);
        result.worst_limit_excess = worst(result.worst_limit_excess, flown.excess);
    }
    Ok(result)
}
