//! Clarabel, a kept interior-point solver: a peer, and with tight tolerances the reference.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus};

use crate::program::{PosedSample, Program};
use crate::solver::{Maker, Solved, Solver};

/// Larger bounds are none.
const UNBOUNDED: f64 = 1e19;

/// Makes Clarabels with a tolerance.
pub struct Clarabels {
    /// Of gap and feasibility; `None` for its own.
    pub tolerance: Option<f64>,
}

impl Maker for Clarabels {
    fn solver<'a>(&'a self, program: &'a Program) -> Option<Box<dyn Solver + 'a>> {
        let mut settings = DefaultSettingsBuilder::default();
        // Without presolving, gradient and bounds can be replaced later.
        settings.verbose(false).presolve_enable(false);
        if let Some(tolerance) = self.tolerance {
            settings.tol_gap_abs(tolerance).tol_gap_rel(tolerance).tol_feas(tolerance);
        }
        let left = program.left_matrix();
        let rows: Vec<Vec<f64>> = left.row_iter().map(|row| row.iter().copied().collect()).collect();
        let first = program.samples.first()?;
        let solver = DefaultSolver::new(
            &CscMatrix::identity(program.unknowns),
            &first.gradient,
            &CscMatrix::from(rows.iter().map(Vec::as_slice)),
            &bounded(&first.upper),
            &[NonnegativeConeT(program.rows)],
            settings.build().ok()?,
        );
        Some(Box::new(Clarabel { solver: solver.ok()?, strict: self.tolerance.is_some() }))
    }
}

/// Clarabel takes no infinite bounds without presolving.
fn bounded(upper: &[f64]) -> Vec<f64> {
    upper.iter().map(|upper| upper.min(UNBOUNDED)).collect()
}

struct Clarabel {
    solver: DefaultSolver<f64>,
    /// Whether what it calls almost solved is not.
    strict: bool,
}

impl Solver for Clarabel {
    fn name(&self) -> &str {
        "Clarabel 0.11.1"
    }

    /// It begins anew each time, warm or not.
    fn solve(&mut self, sample: &PosedSample, _: bool, z: &mut [f64]) -> Solved {
        let updated = self.solver.update_q(&sample.gradient).is_ok()
            && self.solver.update_b(&bounded(&sample.upper)).is_ok();
        if updated {
            self.solver.solve();
            z.copy_from_slice(&self.solver.solution.x);
        }
        let solved = match self.solver.solution.status {
            SolverStatus::Solved => true,
            SolverStatus::AlmostSolved => !self.strict,
            _ => false,
        };
        Solved { solved: updated && solved, iterations: self.solver.solution.iterations }
    }

    fn memory(&self) -> Option<usize> {
        None
    }
}
