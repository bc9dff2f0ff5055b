//! The program of the state-space MPC, condensed anew and solved by Clarabel: a second route to the same moves.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus, SupportedConeT,
};
use nalgebra::{DMatrix, DVector};

use super::axis::Axis;
use super::controllers::{Controller, Move, Placing, Sample, regulator};
use crate::error::Error;

/// min Σ q (y − r)² + q_rate Δẏ² over N_p samples + R Δu² over N_c + the regulator's cost of the state at the end, in
/// ΔU, under the limits.
///
/// Everything known is linear in w = \[y − r; ẏ; u(k−1)\].
pub struct ClarabelMoves {
    solver: DefaultSolver<f64>,
    /// Gradient over w.
    gradient: DMatrix<f64>,
    /// The limits' left-hand sides over w, and their bounds.
    known: DMatrix<f64>,
    bounds: DVector<f64>,
    applied: f64,
}

/// A predicted quantity: by ΔU and by w.
#[derive(Clone)]
struct Predicted {
    moves: DVector<f64>,
    known: DVector<f64>,
}

impl Predicted {
    fn plus(&self, other: &Self, factor: f64) -> Self {
        Self { moves: &self.moves + factor * &other.moves, known: &self.known + factor * &other.known }
    }
}

/// Limits G ΔU + K w ≤ b while they are collected.
#[derive(Default)]
struct Rows {
    rows: Vec<(DVector<f64>, DVector<f64>, f64)>,
}

impl Rows {
    fn add(&mut self, value: &Predicted, [least, most]: [f64; 2]) {
        for (sign, bound) in [(1.0, most), (-1.0, -least)] {
            if bound.is_finite() {
                self.rows.push((sign * &value.moves, sign * &value.known, bound));
            }
        }
    }
}

impl ClarabelMoves {
    /// The program of an axis with `moves` unknowns and limits on some samples.
    ///
    /// # Errors
    /// [`Error::Solver`] when Clarabel refuses it, [`Error::Design`] without a regulator.
    pub fn new(axis: &Axis, moves: usize, placing: Placing<'_>) -> Result<Self, Error> {
        let (hessian, gradient, rows) = condensed(axis, moves, regulator(axis)?.cost(), placing);
        let failed = |reason: String| Error::Solver { problem: axis.name.to_owned(), reason };
        // Without presolve, gradient and bounds can be exchanged in place: no sample pays for a set-up.
        let settings = DefaultSettingsBuilder::default()
            .verbose(false)
            .presolve_enable(false)
            .build()
            .map_err(|error| failed(error.to_string()))?;
        let count = rows.rows.len();
        let matrix = |width: usize, of: &dyn Fn(usize, usize) -> f64| DMatrix::from_fn(count, width, of);
        let left = matrix(moves, &|row, column| rows.rows[row].0[column]);
        let known = matrix(3, &|row, column| rows.rows[row].1[column]);
        let bounds = DVector::from_fn(count, |row, _| rows.rows[row].2);
        let cones: [SupportedConeT<f64>; 1] = [NonnegativeConeT(count)];
        let p = sparse(&hessian.upper_triangle());
        let solver =
            DefaultSolver::new(&p, &vec![0.0; moves], &sparse(&left), bounds.as_slice(), &cones, settings)
                .map_err(|error| failed(error.to_string()))?;
        Ok(Self { solver, gradient, known, bounds, applied: 0.0 })
    }

    /// One sample; the input is held when there is no solution.
    pub fn step(&mut self, sample: &Sample) -> Move {
        let w = DVector::from_column_slice(&[sample.state[0] - sample.goal, sample.state[1], self.applied]);
        let (q, b) = (&self.gradient * &w, &self.bounds - &self.known * &w);
        let updated = self.solver.update_q(&q.as_slice().to_vec()).is_ok()
            && self.solver.update_b(&b.as_slice().to_vec()).is_ok();
        if updated {
            self.solver.solve();
            if self.solver.solution.status == SolverStatus::Solved {
                self.applied += self.solver.solution.x[0];
            }
        }
        let limited = self.solver.solution.z.iter().any(|multiplier| *multiplier > 1e-6);
        Move { input: self.applied, iterations: self.solver.solution.iterations, limited }
    }

    /// As a controller.
    pub fn controller(mut self) -> Controller {
        Box::new(move |sample| self.step(sample))
    }
}

/// H, the gradient over w, and the limits. `end` weights \[Δy, Δẏ, y − r\] at the end of the horizon.
fn condensed(
    axis: &Axis,
    moves: usize,
    end: &DMatrix<f64>,
    placing: Placing<'_>,
) -> (DMatrix<f64>, DMatrix<f64>, Rows) {
    let unit = |index: usize| Predicted {
        moves: DVector::zeros(moves),
        known: DVector::from_fn(3, |i, _| f64::from(u8::from(i == index))),
    };
    let time = axis.sample_time_s;
    let (mut error, mut rate, mut input) = (unit(0), unit(1), unit(2));
    let (mut hessian, mut gradient) = (DMatrix::zeros(moves, moves), DMatrix::zeros(moves, 3));
    let mut charge = |one: &Predicted, other: &Predicted, weight: f64| {
        hessian += 2.0 * weight * &one.moves * other.moves.transpose();
        gradient += 2.0 * weight * &one.moves * other.known.transpose();
    };
    let mut rows = Rows::default();
    for sample in 0..axis.horizon {
        charge(&error, &error, axis.output_weight);
        if sample < moves {
            let mut increment = Predicted { moves: DVector::zeros(moves), known: DVector::zeros(3) };
            increment.moves[sample] = 1.0;
            charge(&increment, &increment, axis.increment_weight);
            input = input.plus(&increment, 1.0);
            if placing.contains(&sample) {
                rows.add(&increment, [-axis.increment, axis.increment]);
            }
        }
        let acceleration = input.plus(&input, axis.gain - 1.0);
        let before = [error.clone(), rate.clone()];
        error = error.plus(&rate, time).plus(&acceleration, time * time / 2.0);
        rate = rate.plus(&acceleration, time);
        if placing.contains(&sample) {
            rows.add(&input, axis.input);
            rows.add(&rate, axis.rate);
        }
        if sample + 1 < axis.horizon {
            charge(&acceleration, &acceleration, axis.rate_weight * time * time);
        } else {
            let last = [error.plus(&before[0], -1.0), rate.plus(&before[1], -1.0), error.clone()];
            for (i, one) in last.iter().enumerate() {
                for (j, other) in last.iter().enumerate() {
                    charge(one, other, end[(i, j)]);
                }
            }
        }
    }
    (hessian, gradient, rows)
}

fn sparse(matrix: &DMatrix<f64>) -> CscMatrix<f64> {
    let rows: Vec<Vec<f64>> = matrix.row_iter().map(|row| row.iter().copied().collect()).collect();
    CscMatrix::from(rows.iter().map(Vec::as_slice))
}

#[cfg(test)]
mod tests {
    use super::super::controllers::{End, regulator, state_space_design};
    use super::{Axis, condensed};

    /// Two condensations by different authors' hands: powers of A in one, a walk over samples in the other.
    #[test]
    fn it_is_the_program_of_the_state_space_design() {
        for axis in Axis::all() {
            for moves in [1, 7, 25] {
                let ours = state_space_design(&axis, moves, End::Riccati).unwrap();
                let (hessian, ..) = condensed(&axis, moves, regulator(&axis).unwrap().cost(), axis.limited);
                let difference = (hessian / 2.0 - ours.hessian()).amax() / ours.hessian().amax();
                assert!(difference < 1e-10, "{}, {moves} moves: {difference}", axis.name);
            }
        }
    }
}
