//! The program of the state-space MPC, condensed anew and solved by Clarabel: a second route to the same moves.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus, SupportedConeT,
};
use nalgebra::{DMatrix, DVector};

use super::axis::Axis;
use super::controllers::{Controller, Move, Sample};
use crate::error::Error;

/// min Σ \[Δx; y − r\]ᵀ Q \[Δx; y − r\] over N_p samples + Δuᵀ R Δu over N_c + the regulator's cost of the state at the end, in ΔU,
/// under the limits of inputs and states, sample by sample.
///
/// Everything known is linear in w = \[x without the set-point; u(k−1)\].
pub struct ClarabelMoves {
    solver: DefaultSolver<f64>,
    /// Gradient over w.
    gradient: DMatrix<f64>,
    /// The limits' left-hand sides over w, and their bounds.
    known: DMatrix<f64>,
    bounds: DVector<f64>,
    applied: DVector<f64>,
}

/// Predicted quantities: by ΔU and by w.
#[derive(Clone)]
struct Predicted {
    moves: DMatrix<f64>,
    known: DMatrix<f64>,
}

impl Predicted {
    fn zero(rows: usize, moves: usize, known: usize) -> Self {
        Self { moves: DMatrix::zeros(rows, moves), known: DMatrix::zeros(rows, known) }
    }

    fn times(&self, factor: &DMatrix<f64>) -> Self {
        Self { moves: factor * &self.moves, known: factor * &self.known }
    }

    fn plus(&self, other: &Self) -> Self {
        Self { moves: &self.moves + &other.moves, known: &self.known + &other.known }
    }

    fn minus(&self, other: &Self) -> Self {
        Self { moves: &self.moves - &other.moves, known: &self.known - &other.known }
    }
}

/// Cost and limits of a program while they are collected: G ΔU + K w ≤ b.
struct Condensed {
    hessian: DMatrix<f64>,
    gradient: DMatrix<f64>,
    left: Vec<DMatrix<f64>>,
    known: Vec<DMatrix<f64>>,
    bounds: Vec<f64>,
}

impl Condensed {
    fn charge(&mut self, one: &Predicted, weight: &DMatrix<f64>) {
        let weighted = 2.0 * one.moves.transpose() * weight;
        self.hessian += &weighted * &one.moves;
        self.gradient += &weighted * &one.known;
    }

    fn limit(&mut self, value: &Predicted, upper: f64) {
        if value.moves.amax() > 0.0 {
            self.left.push(value.moves.clone());
            self.known.push(value.known.clone());
            self.bounds.push(upper);
        }
    }
}

impl ClarabelMoves {
    /// The program of a loop with `moves` unknowns per input.
    ///
    /// # Errors
    /// [`Error::Solver`] when Clarabel refuses it, [`Error::Design`] without a regulator.
    pub fn new(axis: &Axis, moves: usize) -> Result<Self, Error> {
        let condensed = condensed(axis, moves, axis.regulator()?.cost());
        let failed = |reason: String| Error::Solver { problem: axis.name.to_owned(), reason };
        // Without presolve, gradient and bounds can be exchanged in place: no sample pays for a set-up.
        let settings = DefaultSettingsBuilder::default()
            .verbose(false)
            .presolve_enable(false)
            .build()
            .map_err(|error| failed(error.to_string()))?;
        let count = condensed.bounds.len();
        let stacked = |rows: &[DMatrix<f64>], width: usize| {
            DMatrix::from_fn(count, width, |row, column| rows[row][(0, column)])
        };
        let unknowns = condensed.hessian.nrows();
        let left = stacked(&condensed.left, unknowns);
        let known = stacked(&condensed.known, condensed.gradient.ncols());
        let bounds = DVector::from_vec(condensed.bounds);
        let cones: [SupportedConeT<f64>; 1] = [NonnegativeConeT(count)];
        let p = sparse(&condensed.hessian.upper_triangle());
        let solver =
            DefaultSolver::new(&p, &vec![0.0; unknowns], &sparse(&left), bounds.as_slice(), &cones, settings)
                .map_err(|error| failed(error.to_string()))?;
        let applied = DVector::zeros(axis.linear.model.inputs());
        Ok(Self { solver, gradient: condensed.gradient, known, bounds, applied })
    }

    /// One sample; the input is held when there is no solution.
    pub fn step(&mut self, sample: &Sample) -> Move {
        let states = sample.deviation.len();
        let known = states + self.applied.len();
        let w = DVector::from_fn(known, |row, _| {
            if row < states { sample.deviation[row] } else { self.applied[row - states] }
        });
        let (q, b) = (&self.gradient * &w, &self.bounds - &self.known * &w);
        let updated = self.solver.update_q(&q.as_slice().to_vec()).is_ok()
            && self.solver.update_b(&b.as_slice().to_vec()).is_ok();
        if updated {
            self.solver.solve();
            if self.solver.solution.status == SolverStatus::Solved {
                let moves = &self.solver.solution.x;
                self.applied = DVector::from_fn(self.applied.len(), |row, _| self.applied[row] + moves[row]);
            }
        }
        let limited = self.solver.solution.z.iter().any(|multiplier| *multiplier > 1e-6);
        Move { input: self.applied.clone(), iterations: self.solver.solution.iterations, limited }
    }

    /// As a controller.
    pub fn controller(mut self) -> Controller {
        Box::new(move |sample| self.step(sample))
    }
}

/// `end` weights \[Δx; y − r\] at the end of the horizon.
fn condensed(axis: &Axis, moves: usize, end: &DMatrix<f64>) -> Condensed {
    let linear = &axis.linear;
    let (model, q, r) = (&linear.model, linear.weights.q(), linear.weights.r());
    let (states, inputs) = (model.states(), model.inputs());
    let (unknowns, known) = (inputs * moves, states + inputs);
    let mut state = Predicted::zero(states, unknowns, known);
    state.known.view_mut((0, 0), (states, states)).fill_with_identity();
    let mut input = Predicted::zero(inputs, unknowns, known);
    input.known.view_mut((0, states), (inputs, inputs)).fill_with_identity();
    let mut condensed = Condensed {
        hessian: DMatrix::zeros(unknowns, unknowns),
        gradient: DMatrix::zeros(unknowns, known),
        left: Vec::new(),
        known: Vec::new(),
        bounds: Vec::new(),
    };
    let of_outputs = q.view((states, states), (inputs, inputs)).into_owned();
    let of_motion = q.view((0, 0), (states, states)).into_owned();
    // Limits may reach further than the cost does.
    let limited = linear.limits.iter().flat_map(|limit| &limit.samples).map(|last| last + 1);
    for sample in 0..limited.fold(linear.prediction_horizon, usize::max) {
        if sample < moves {
            let mut change = Predicted::zero(inputs, unknowns, known);
            change.moves.view_mut((0, inputs * sample), (inputs, inputs)).fill_with_identity();
            condensed.charge(&change, r);
            input = input.plus(&change);
        }
        for (limit, direction, upper) in axis.bounds().filter(|(limit, ..)| limit.samples.contains(&sample)) {
            // A limit of states holds at sample m ≥ 1, of the input at m ≥ 0.
            let along = limit.directions.row(direction).into_owned();
            let along = DMatrix::from_row_slice(1, along.len(), along.transpose().as_slice());
            let value = state.times(&(&along * &limit.state)).plus(&input.times(&(&along * &limit.input)));
            condensed.limit(&value, upper);
        }
        let next = state.times(model.a()).plus(&input.times(model.b()));
        let motion = next.minus(&state);
        if sample < linear.prediction_horizon {
            condensed.charge(&state.times(model.c()), &of_outputs);
        }
        if sample + 1 < linear.prediction_horizon {
            condensed.charge(&motion, &of_motion);
        } else if sample + 1 == linear.prediction_horizon {
            let mut last = Predicted::zero(states + inputs, unknowns, known);
            let error = next.times(model.c());
            last.moves.rows_mut(0, states).copy_from(&motion.moves);
            last.known.rows_mut(0, states).copy_from(&motion.known);
            last.moves.rows_mut(states, inputs).copy_from(&error.moves);
            last.known.rows_mut(states, inputs).copy_from(&error.known);
            condensed.charge(&last, end);
        }
        state = next;
    }
    condensed
}

fn sparse(matrix: &DMatrix<f64>) -> CscMatrix<f64> {
    let rows: Vec<Vec<f64>> = matrix.row_iter().map(|row| row.iter().copied().collect()).collect();
    CscMatrix::from(rows.iter().map(Vec::as_slice))
}

#[cfg(test)]
mod tests {
    use super::super::controllers::{End, state_space_design};
    use super::{Axis, condensed};

    /// Two condensations by different authors' hands: powers of A in one, a walk over samples in the other.
    #[test]
    fn it_is_the_program_of_the_state_space_design() {
        for axis in Axis::all().unwrap() {
            for moves in [1, 7, 25] {
                let ours = state_space_design(&axis, moves, End::Riccati).unwrap();
                let theirs = condensed(&axis, moves, axis.regulator().unwrap().cost());
                let difference = (theirs.hessian / 2.0 - ours.hessian()).amax() / ours.hessian().amax();
                assert!(difference < 1e-10, "{}, {moves} moves: {difference}", axis.name);
            }
        }
    }
}
