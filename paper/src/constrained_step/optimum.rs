//! The least cost of a step under all limits at all samples, by a solver that is not ours.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus, SupportedConeT,
    ZeroConeT,
};

use super::axis::Axis;
use super::flight::SAMPLES;
use crate::error::Error;

/// Unknowns of one sample: Δu(k), u(k), y(k) − r, ẏ(k).
const PER_SAMPLE: usize = 4;
const INCREMENT: usize = 0;
const INPUT: usize = 1;
const ERROR: usize = 2;
const RATE: usize = 3;

/// The whole step of 1500 samples as one sparse program: no receding horizon, no terminal weight, no choice of
/// samples. By Bellman's principle no controller that keeps the limits costs less.
///
/// # Errors
/// [`Error::Solver`] when Clarabel finds no optimum.
pub fn optimum(axis: &Axis, goal: f64) -> Result<f64, Error> {
    let mut triplets = Triplets::default();
    equations(axis, goal, &mut triplets);
    let equations = triplets.right.len();
    inequalities(axis, &mut triplets);
    let inequalities = triplets.right.len() - equations;

    let unknowns = PER_SAMPLE * SAMPLES;
    let (quadratic, linear) = (cost(axis), vec![0.0; unknowns]);
    let p = CscMatrix::new_from_triplets(
        unknowns,
        unknowns,
        (0..unknowns).collect(),
        (0..unknowns).collect(),
        quadratic,
    );
    let a = CscMatrix::new_from_triplets(
        triplets.right.len(),
        unknowns,
        triplets.rows,
        triplets.columns,
        triplets.values,
    );
    let cones: [SupportedConeT<f64>; 2] = [ZeroConeT(equations), NonnegativeConeT(inequalities)];
    let failed = |reason: String| Error::Solver { problem: axis.problem(goal), reason };
    let settings = DefaultSettingsBuilder::default()
        .verbose(false)
        .tol_gap_rel(1e-10)
        .tol_gap_abs(1e-10)
        .tol_feas(1e-10)
        .build()
        .map_err(|error| failed(error.to_string()))?;
    let mut solver = DefaultSolver::new(&p, &linear, &a, &triplets.right, &cones, settings)
        .map_err(|error| failed(error.to_string()))?;
    solver.solve();
    match solver.solution.status {
        SolverStatus::Solved | SolverStatus::AlmostSolved => Ok(solver.solution.obj_val),
        status => Err(failed(format!("{status:?}"))),
    }
}

/// A x + s = right, s in the cones.
#[derive(Default)]
struct Triplets {
    rows: Vec<usize>,
    columns: Vec<usize>,
    values: Vec<f64>,
    right: Vec<f64>,
}

impl Triplets {
    fn add(&mut self, right: f64, entries: impl IntoIterator<Item = (usize, usize, f64)>) {
        let row = self.right.len();
        for (sample, unknown, value) in entries {
            self.rows.push(row);
            self.columns.push(PER_SAMPLE * sample + unknown);
            self.values.push(value);
        }
        self.right.push(right);
    }
}

/// From rest at 0 with u(−1) = 0: u(k) = u(k−1) + Δu(k), and the model from each sample to the next.
fn equations(axis: &Axis, goal: f64, triplets: &mut Triplets) {
    let time = axis.sample_time_s;
    triplets.add(0.0, [(0, INPUT, 1.0), (0, INCREMENT, -1.0)]);
    triplets.add(-goal, [(0, ERROR, 1.0)]);
    triplets.add(0.0, [(0, RATE, 1.0)]);
    for k in 1..SAMPLES {
        let last = k - 1;
        triplets.add(0.0, [(k, INPUT, 1.0), (last, INPUT, -1.0), (k, INCREMENT, -1.0)]);
        let moved = axis.gain * time * time / 2.0;
        triplets.add(0.0, [(k, ERROR, 1.0), (last, ERROR, -1.0), (last, RATE, -time), (last, INPUT, -moved)]);
        triplets.add(0.0, [(k, RATE, 1.0), (last, RATE, -1.0), (last, INPUT, -axis.gain * time)]);
    }
}

fn inequalities(axis: &Axis, triplets: &mut Triplets) {
    let increment = [-axis.increment, axis.increment];
    for k in 0..SAMPLES {
        for (unknown, [least, most]) in [(INCREMENT, increment), (INPUT, axis.input), (RATE, axis.rate)] {
            if most.is_finite() {
                triplets.add(most, [(k, unknown, 1.0)]);
            }
            if least.is_finite() {
                triplets.add(-least, [(k, unknown, -1.0)]);
            }
        }
    }
}

/// Diagonal of P in ½ xᵀPx.
fn cost(axis: &Axis) -> Vec<f64> {
    // Δẏ(k+1) = gain ΔT u(k)
    let rate = axis.rate_weight * (axis.gain * axis.sample_time_s).powi(2);
    (0..SAMPLES)
        .flat_map(|k| {
            let rate = if k + 1 < SAMPLES { rate } else { 0.0 };
            [2.0 * axis.increment_weight, 2.0 * rate, 2.0 * axis.output_weight, 0.0]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use lmpc::Weighting;

    use super::super::controllers::laguerre;
    use super::super::flight::fly;
    use super::{Axis, optimum};

    /// Our solver with 120 free moves at each sample and limits on all of them flies Clarabel's optimum.
    #[test]
    fn our_own_solver_flies_the_optimum() {
        let [axis, _, roll, _] = Axis::all();
        for (axis, step) in [(axis, 5.0), (roll, 1.0)] {
            let axis = Axis { horizon: 150, ..axis };
            let all: Vec<usize> = (0..120).collect();
            let terminal = Weighting::Terminal { lambda: 1.0 };
            let controller = laguerre::<{ lmpc::unknowns(1, 120) }>(&axis, 120, 0.0, terminal, &all).unwrap();
            let (ours, theirs) = (fly(&axis, step, controller).cost, optimum(&axis, step).unwrap());
            assert!((ours / theirs - 1.0).abs() < 1e-5, "{}: {ours}, {theirs}", axis.name);
        }
    }
}
