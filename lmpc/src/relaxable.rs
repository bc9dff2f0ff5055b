//! A quadratic program whose constraints give way when they contradict one another.

use nalgebra::{DMatrix, SVector};
use serde::{Deserialize, Serialize};

use crate::{DesignError, Outcome, QuadraticProgram, Solution, Status, WarmStart};

/// Weight of the slack against the largest element of H: constraints give way when they must, not to save
/// cost.
const SLACK_WEIGHT: f64 = 1e4;
/// Share of the slack that hard constraints get in a relaxed problem.
const HARD_SHARE: f64 = 1e-3;

/// min ½ xᵀHx + fᵀx subject to G x ≤ h; where no x meets that, subject to G x ≤ h + s σ with a common slack
/// σ that is charged quadratically, s = 1 for soft rows and a thousandth for hard ones.
///
/// E must hold the unknowns and the slack; what it has beyond stays zero.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RelaxableProgram<const E: usize> {
    strict: QuadraticProgram<E>,
    relaxed: QuadraticProgram<E>,
    iteration_limit: u32,
}

/// The last active sets, strict and relaxed.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct RelaxableWarmStart<const E: usize> {
    strict: WarmStart<E>,
    relaxed: WarmStart<E>,
}

impl<const E: usize> RelaxableProgram<E> {
    /// For H, n×n, and G, m×n, with n < E, and which of its rows are soft.
    pub(crate) fn new(h: &DMatrix<f64>, g: &DMatrix<f64>, soft: &[bool]) -> Result<Self, DesignError> {
        let unknowns = h.nrows();
        if unknowns + 1 > E {
            let actual = (unknowns + 1, unknowns + 1);
            return Err(DesignError::Dimension { name: "H with slack", expected: (E, E), actual });
        }
        let mut extended_h = h.clone().resize(unknowns + 1, unknowns + 1, 0.0);
        extended_h[(unknowns, unknowns)] = SLACK_WEIGHT * h.amax();

        let mut extended_g = DMatrix::zeros(g.nrows(), unknowns + 1);
        extended_g.view_mut((0, 0), g.shape()).copy_from(g);
        let strict = QuadraticProgram::new(&extended_h, &extended_g)?;
        for (row, soft) in soft.iter().enumerate() {
            extended_g[(row, unknowns)] = if *soft { -1.0 } else { -HARD_SHARE };
        }
        let relaxed = QuadraticProgram::new(&extended_h, &extended_g)?;
        let size = u32::try_from(unknowns + 1 + g.nrows()).unwrap_or(u32::MAX / 4);
        Ok(Self { strict, relaxed, iteration_limit: 4 * size })
    }

    /// Solves it for one f and one h, given row by row.
    pub(crate) fn solve<const W: usize>(
        &self,
        f: &SVector<f64, E>,
        h: impl Fn(usize) -> f64,
        warm_start: &mut RelaxableWarmStart<W>,
    ) -> (Solution<E>, Status) {
        let strict = self.strict.solve_with(f, &h, &mut warm_start.strict, self.iteration_limit);
        // What the strict program cannot settle in time the relaxed one may.
        if !matches!(strict.outcome, Outcome::Infeasible | Outcome::IterationLimit) {
            return (strict, status_of(strict.outcome, Status::Optimal));
        }
        let relaxed = self.relaxed.solve_with(f, &h, &mut warm_start.relaxed, self.iteration_limit);
        let iterations = strict.iterations + relaxed.iterations;
        (Solution { iterations, ..relaxed }, status_of(relaxed.outcome, Status::Relaxed))
    }
}

fn status_of(outcome: Outcome, solved: Status) -> Status {
    match outcome {
        Outcome::Optimal => solved,
        // Relaxed constraints can always be met; in floating point they may come out as if not.
        Outcome::IterationLimit | Outcome::Infeasible => Status::IterationLimit,
        Outcome::NotFinite => Status::Held,
    }
}
