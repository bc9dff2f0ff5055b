//! Random quadratic programs, and another solver for them.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus};
use nalgebra::{DMatrix, DVector, SVector};
use proptest::prelude::*;

/// Unknowns.
pub const N: usize = 6;
/// Iterations that no problem here needs.
pub const LIMIT: u32 = 1000;

/// min ½ xᵀHx + fᵀx subject to G x ≤ bounds.
#[derive(Clone, Debug)]
pub struct Problem {
    pub h: DMatrix<f64>,
    pub f: SVector<f64, N>,
    pub g: DMatrix<f64>,
    pub bounds: Vec<f64>,
}

impl Problem {
    pub fn cost(&self, x: &SVector<f64, N>) -> f64 {
        let x = DVector::from_column_slice(x.as_slice());
        0.5 * (x.transpose() * &self.h * &x)[0]
            + self.f.dot(&SVector::<f64, N>::from_column_slice(x.as_slice()))
    }

    pub fn violation(&self, x: &SVector<f64, N>) -> f64 {
        let left = &self.g * DVector::from_column_slice(x.as_slice());
        left.iter().zip(&self.bounds).map(|(left, bound)| left - bound).fold(0.0, f64::max)
    }

    /// With all bounds lower by that much.
    pub fn tightened(&self, by: f64) -> Self {
        Self { bounds: self.bounds.iter().map(|bound| bound - by).collect(), ..self.clone() }
    }
}

/// Random problems: H from well to badly conditioned, bounds from loose to contradictory, some constraints
/// repeated or almost repeated.
pub fn problem() -> impl Strategy<Value = Problem> {
    (
        prop::collection::vec(-1.0..1.0, N * N),
        -3.0..1.0,
        prop::array::uniform6(-5.0..5.0),
        (0usize..25).prop_flat_map(|m| {
            (prop::collection::vec(-1.0..1.0, m * N), prop::collection::vec(-0.3..1.0, m))
        }),
        any::<bool>(),
        0.0..1e-6,
    )
        .prop_map(|(root, regular, f, (rows, mut bounds), repeated, nearly)| {
            let root = DMatrix::from_vec(N, N, root);
            let h = root.transpose() * &root + DMatrix::identity(N, N) * 10_f64.powf(regular);
            let mut g = DMatrix::from_row_slice(bounds.len(), N, &rows);
            if repeated && bounds.len() > 1 {
                let last = bounds.len() - 1;
                let first = g.row(0).into_owned();
                g.set_row(last, &(first * (1.0 + nearly)));
                bounds[last] = bounds[0];
            }
            Problem { h, f: f.into(), g, bounds }
        })
}

/// The same problem by Clarabel: optimum, or none.
pub fn clarabel(problem: &Problem) -> Option<SVector<f64, N>> {
    let upper = problem.h.upper_triangle();
    let p = CscMatrix::from(
        upper
            .row_iter()
            .map(|row| row.iter().copied().collect::<Vec<_>>())
            .collect::<Vec<_>>()
            .iter()
            .map(Vec::as_slice),
    );
    let rows: Vec<Vec<f64>> = problem.g.row_iter().map(|row| row.iter().copied().collect()).collect();
    let a = if rows.is_empty() {
        CscMatrix::zeros((0, N))
    } else {
        CscMatrix::from(rows.iter().map(Vec::as_slice))
    };
    let settings = DefaultSettingsBuilder::default()
        .verbose(false)
        .tol_gap_abs(1e-11)
        .tol_gap_rel(1e-11)
        .tol_feas(1e-11)
        .build()
        .unwrap();
    let cones = [NonnegativeConeT(problem.bounds.len())];
    let mut solver =
        DefaultSolver::new(&p, problem.f.as_slice(), &a, &problem.bounds, &cones, settings).unwrap();
    solver.solve();
    match solver.solution.status {
        SolverStatus::Solved | SolverStatus::AlmostSolved => {
            Some(SVector::from_column_slice(&solver.solution.x))
        }
        _ => None,
    }
}
