//! What a controller on a step under limits costs, or why it was not designed.

use lmpc::DesignError;
use schemars::JsonSchema;
use serde::Serialize;

use super::flight::Flown;
use crate::error::Error;

/// One controller on one step under limits.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct CostResult {
    /// The step.
    pub problem: String,
    /// The controller and its design choices.
    pub controller: String,
    /// Unknowns per input: N of LMPC, N_c of state-space MPC, 0 of the regulator.
    pub n: usize,
    /// Σ \[Δx; y − r\]ᵀ Q \[Δx; y − r\] + Δuᵀ R Δu of the whole step; null where the design was refused.
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

/// A design that is not stable, or too ill-conditioned, is a result; any other refusal is a mistake.
pub(super) fn entry<T>(
    name: String,
    n: usize,
    controller: Result<T, DesignError>,
) -> Result<(Contender, Option<T>), Error> {
    match controller {
        Ok(controller) => Ok((Contender { name, n, refused: None }, Some(controller))),
        Err(error @ (DesignError::Unstable { .. } | DesignError::IllConditioned { .. })) => {
            Ok((Contender { name, n, refused: Some(error.to_string()) }, None))
        }
        Err(error) => Err(error.into()),
    }
}
