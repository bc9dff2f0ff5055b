//! A quadratic program whose constraints give way when they contradict one another.

use nalgebra::{DMatrix, SVector};
use serde::{Deserialize, Serialize};

use crate::bounds::Bounds;
use crate::capacity::{SLACKS, iteration_limit};
use crate::limit_row::LimitRow;
use crate::{DesignError, Outcome, Precision, QuadraticProgram, Solution, Status, WarmStart};

/// Weight of the slack against the largest element of H: constraints give way when they must, not to save
/// cost.
const SLACK_WEIGHT: f64 = 1e4;

/// min ½ xᵀHx + fᵀx subject to G x ≤ h; where no x meets that, subject to G x ≤ h + s σ with a common slack
/// σ that is charged quadratically: s = 1 for soft rows and 0 for hard ones first and, where no x meets that
/// either, s = 1 for all.
///
/// E must hold the unknowns and the slack; what it has beyond stays zero.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "T: Precision")]
pub(crate) struct RelaxableProgram<const E: usize, T = f64> {
    /// With no slack, with slack for soft rows, with slack for all.
    stages: [QuadraticProgram<E, T>; STAGES],
    iteration_limit: u32,
}

const STAGES: usize = 3;

/// The last active sets of the three stages.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct RelaxableWarmStart<const W: usize> {
    stages: [WarmStart<W>; STAGES],
}

impl<const W: usize> RelaxableWarmStart<W> {
    /// That of the program without slack.
    pub(crate) fn strict(&mut self) -> &mut WarmStart<W> {
        let [strict, ..] = &mut self.stages;
        strict
    }
}

impl<const E: usize> RelaxableProgram<E> {
    /// For H, n×n with n < E, and the rows of G, 1×n each.
    pub(crate) fn new(h: &DMatrix<f64>, rows: &[LimitRow]) -> Result<Self, DesignError> {
        let unknowns = h.nrows();
        let mut g = DMatrix::zeros(rows.len(), unknowns);
        for (index, row) in rows.iter().enumerate() {
            g.set_row(index, &row.decision);
        }
        let size = unknowns + SLACKS;
        if size > E {
            let actual = (size, size);
            return Err(DesignError::Dimension { name: "H with slack", expected: (E, E), actual });
        }
        let mut extended_h = h.clone().resize(size, size, 0.0);
        extended_h[(unknowns, unknowns)] = SLACK_WEIGHT * h.amax();
        let stage = |gives_way: &dyn Fn(usize) -> bool| {
            let mut extended_g = g.clone().resize_horizontally(size, 0.0);
            for row in (0..g.nrows()).filter(|row| gives_way(*row)) {
                extended_g[(row, unknowns)] = -1.0;
            }
            QuadraticProgram::new(&extended_h, &extended_g)
        };
        let is_soft = |row: usize| rows.get(row).is_some_and(|row| row.soft);
        Ok(Self {
            stages: [stage(&|_| false)?, stage(&is_soft)?, stage(&|_| true)?],
            iteration_limit: iteration_limit(size, g.nrows()),
        })
    }
}

impl<const E: usize, T: Precision> RelaxableProgram<E, T> {
    /// The same program in another precision.
    pub(crate) fn to_precision<U: Precision>(&self) -> RelaxableProgram<E, U> {
        RelaxableProgram {
            stages: self.stages.each_ref().map(QuadraticProgram::to_precision),
            iteration_limit: self.iteration_limit,
        }
    }

    /// Solves it for one f and one h, given row by row.
    pub(crate) fn solve<const W: usize>(
        &self,
        f: &SVector<T, E>,
        h: &impl Bounds<T>,
        warm_start: &mut RelaxableWarmStart<W>,
    ) -> (Solution<E, T>, Status) {
        let [strict, further @ ..] = &self.stages;
        let [warm, further_warm @ ..] = &mut warm_start.stages;
        let mut solution = strict.solve_with(f, h, warm, self.iteration_limit);
        let mut solved = Status::Optimal;
        for (program, warm) in further.iter().zip(further_warm) {
            // What one stage cannot settle in time the next may.
            if matches!(solution.outcome, Outcome::Optimal | Outcome::NotFinite) {
                break;
            }
            let iterations = solution.iterations;
            solution = program.solve_with(f, h, warm, self.iteration_limit);
            solution.iterations += iterations;
            solved = Status::Relaxed;
        }
        (solution, status_of(solution.outcome, solved))
    }
}

fn status_of(outcome: Outcome, solved: Status) -> Status {
    match outcome {
        Outcome::Optimal => solved,
        // With slack for all rows they can always be met; in floating point they may come out as if not.
        Outcome::IterationLimit | Outcome::Infeasible => Status::IterationLimit,
        Outcome::NotFinite => Status::Held,
    }
}
