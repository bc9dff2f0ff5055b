//! The least cost of a step under all limits at all samples, by a solver that is not ours.

use std::collections::BTreeMap;

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus, SupportedConeT,
    ZeroConeT,
};

use super::axis::{Axis, Step};
use super::flight::SAMPLES;
use crate::error::Error;

/// The whole step as one sparse program: no receding horizon, no terminal weight, no choice of samples. By Bellman's
/// principle no controller that keeps the limits costs less.
///
/// # Errors
/// [`Error::Solver`] when Clarabel finds no optimum.
pub fn optimum(axis: &Axis, step: &Step) -> Result<f64, Error> {
    let unknowns = Unknowns { states: axis.linear.model.states(), inputs: axis.linear.model.inputs() };
    let mut triplets = Triplets::default();
    equations(axis, step, unknowns, &mut triplets);
    let equations = triplets.right.len();
    inequalities(axis, unknowns, &mut triplets);
    let inequalities = triplets.right.len() - equations;

    let count = unknowns.per_sample() * SAMPLES;
    let (mut rows, mut columns, mut values) = (Vec::new(), Vec::new(), Vec::new());
    for ((row, column), value) in cost(axis, unknowns) {
        rows.push(row);
        columns.push(column);
        values.push(value);
    }
    let p = CscMatrix::new_from_triplets(count, count, rows, columns, values);
    let a = CscMatrix::new_from_triplets(
        triplets.right.len(),
        count,
        triplets.rows,
        triplets.columns,
        triplets.values,
    );
    let cones: [SupportedConeT<f64>; 2] = [ZeroConeT(equations), NonnegativeConeT(inequalities)];
    let failed = |reason: String| Error::Solver { problem: step.problem.to_owned(), reason };
    let settings = DefaultSettingsBuilder::default()
        .verbose(false)
        .tol_gap_rel(1e-9)
        .tol_gap_abs(1e-9)
        .tol_feas(1e-9)
        .build()
        .map_err(|error| failed(error.to_string()))?;
    let mut solver = DefaultSolver::new(&p, &vec![0.0; count], &a, &triplets.right, &cones, settings)
        .map_err(|error| failed(error.to_string()))?;
    solver.solve();
    match solver.solution.status {
        SolverStatus::Solved | SolverStatus::AlmostSolved => Ok(solver.solution.obj_val),
        status => Err(failed(format!("{status:?}"))),
    }
}

/// The unknowns of one sample: x without the set-point, u, and Δu.
#[derive(Clone, Copy)]
struct Unknowns {
    states: usize,
    inputs: usize,
}

impl Unknowns {
    fn per_sample(self) -> usize {
        self.states + 2 * self.inputs
    }

    fn state(self, sample: usize, state: usize) -> usize {
        sample * self.per_sample() + state
    }

    fn input(self, sample: usize, input: usize) -> usize {
        self.state(sample, self.states) + input
    }

    fn change(self, sample: usize, input: usize) -> usize {
        self.input(sample, self.inputs) + input
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
    fn add(&mut self, right: f64, entries: impl IntoIterator<Item = (usize, f64)>) {
        let row = self.right.len();
        for (unknown, value) in entries.into_iter().filter(|(_, value)| *value != 0.0) {
            self.rows.push(row);
            self.columns.push(unknown);
            self.values.push(value);
        }
        self.right.push(right);
    }
}

/// From rest at the origin with u(−1) = 0: u(k) = u(k−1) + Δu(k), and the model from each sample to the next.
fn equations(axis: &Axis, step: &Step, unknowns: Unknowns, triplets: &mut Triplets) {
    let (a, b) = (axis.linear.model.a(), axis.linear.model.b());
    for (state, goal) in axis.at_rest(&step.goal).iter().enumerate() {
        triplets.add(-goal, [(unknowns.state(0, state), 1.0)]);
    }
    for k in 0..SAMPLES {
        for input in 0..unknowns.inputs {
            let before = (k > 0).then(|| (unknowns.input(k - 1, input), -1.0));
            let now = [(unknowns.input(k, input), 1.0), (unknowns.change(k, input), -1.0)];
            triplets.add(0.0, now.into_iter().chain(before));
        }
        if k + 1 == SAMPLES {
            break;
        }
        for state in 0..unknowns.states {
            let next = (unknowns.state(k + 1, state), 1.0);
            let of_states = (0..unknowns.states).map(|from| (unknowns.state(k, from), -a[(state, from)]));
            let of_inputs = (0..unknowns.inputs).map(|from| (unknowns.input(k, from), -b[(state, from)]));
            triplets.add(0.0, std::iter::once(next).chain(of_states).chain(of_inputs));
        }
    }
}

/// Limits do not bound the outputs themselves, so that the set-point does not enter.
fn inequalities(axis: &Axis, unknowns: Unknowns, triplets: &mut Triplets) {
    for (limit, direction, upper) in axis.bounds() {
        let of_states = limit.directions.row(direction) * &limit.state;
        let of_inputs = limit.directions.row(direction) * &limit.input;
        for k in 0..SAMPLES {
            let states = of_states.iter().enumerate().map(|(at, value)| (unknowns.state(k, at), *value));
            let inputs = of_inputs.iter().enumerate().map(|(at, value)| (unknowns.input(k, at), *value));
            triplets.add(upper, states.chain(inputs).collect::<Vec<_>>());
        }
    }
}

/// The upper triangle of P in ½ xᵀPx.
fn cost(axis: &Axis, unknowns: Unknowns) -> BTreeMap<(usize, usize), f64> {
    let (q, r) = (axis.linear.weights.q(), axis.linear.weights.r());
    let (states, inputs) = (unknowns.states, unknowns.inputs);
    let mut entries = BTreeMap::new();
    // Of a quadratic form a b with the weight w: P has 2 w on the diagonal and w beside it, above and below.
    let mut charge = |one: usize, other: usize, weight: f64| {
        let diagonal = if one == other { 2.0 } else { 1.0 };
        if weight != 0.0 {
            *entries.entry((one.min(other), one.max(other))).or_insert(0.0) += diagonal * weight;
        }
    };
    for k in 0..SAMPLES {
        for i in 0..inputs {
            for j in 0..inputs {
                charge(unknowns.change(k, i), unknowns.change(k, j), r[(i, j)]);
                let (e_i, e_j) =
                    (unknowns.state(k, i * states / inputs), unknowns.state(k, j * states / inputs));
                charge(e_i, e_j, q[(states + i, states + j)]);
            }
        }
        if k == 0 {
            continue;
        }
        for i in 0..states {
            for j in 0..states {
                let weight = q[(i, j)];
                for (before_i, sign_i) in [(k, 1.0), (k - 1, -1.0)] {
                    for (before_j, sign_j) in [(k, 1.0), (k - 1, -1.0)] {
                        let (one, other) = (unknowns.state(before_i, i), unknowns.state(before_j, j));
                        charge(one, other, sign_i * sign_j * weight);
                    }
                }
            }
        }
    }
    entries
}

#[cfg(test)]
mod tests {
    use lmpc::{SignalLimit, StabilizedMpc, unknowns};

    use super::super::axis::Axis;
    use super::super::controllers::flying;
    use super::super::flight::fly;
    use super::optimum;

    /// Our solver with 60 free moves and limits on all samples flies Clarabel's optimum.
    #[test]
    fn our_own_solver_flies_the_optimum() {
        const MOVES: usize = 60;
        let [_, altitude, ..] = Axis::all().unwrap();
        let everywhere = |limit: &SignalLimit| SignalLimit { samples: (0..200).collect(), ..limit.clone() };
        let limits: Vec<SignalLimit> = altitude.linear.limits.iter().map(everywhere).collect();
        let design = altitude.linear.design(MOVES, 0.0).unwrap();
        for step in &altitude.steps[..2] {
            let law = StabilizedMpc::<3, 1, 1, { unknowns(1, MOVES) }>::new(
                &design,
                &limits,
                altitude.linear.slack_cost,
            );
            let ours = fly(&altitude, step, flying::<3, 1, { unknowns(1, MOVES) }>(&altitude, law.unwrap()));
            let theirs = optimum(&altitude, step).unwrap();
            assert!((ours.cost / theirs - 1.0).abs() < 1e-4, "{}: {}, {theirs}", step.problem, ours.cost);
        }
    }
}
