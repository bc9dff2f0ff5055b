//! Plans about a stabilizing feedback, simulated move by move, and their program in another solver: an oracle that shares neither
//! the recursions nor the search of the library.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus};
use lmpc::{LaguerreBasis, SignalLimit, StabilizedDesign};
use nalgebra::{DMatrix, DVector};

/// What a plan begins with.
#[derive(Clone, Debug)]
pub struct Start {
    pub measured: DVector<f64>,
    pub increment: DVector<f64>,
    pub error: DVector<f64>,
    pub input: DVector<f64>,
}

impl Start {
    /// x = [Δx_m; y − r].
    pub fn augmented(&self) -> DVector<f64> {
        DVector::from_iterator(
            self.increment.len() + self.error.len(),
            self.increment.iter().chain(self.error.iter()).copied(),
        )
    }
}

/// What a plan does at its samples m = 0, 1, …
#[derive(Clone, Debug)]
pub struct Planned {
    /// x(k+m), augmented.
    pub augmented: Vec<DVector<f64>>,
    pub moves: Vec<DVector<f64>>,
    /// x_m(k+m) and u(k+m).
    pub states: Vec<DVector<f64>>,
    pub inputs: Vec<DVector<f64>>,
}

/// Δu(k+m) = −K_s x(k+m) + L(m)ᵀη on the plant itself.
pub fn simulate(design: &StabilizedDesign, start: &Start, eta: &DVector<f64>, samples: usize) -> Planned {
    let plant = design.model().plant();
    let mut planned = Planned { augmented: vec![], moves: vec![], states: vec![], inputs: vec![] };
    let mut now = start.clone();
    let mut functions: Vec<DVector<f64>> =
        design.bases().iter().map(|basis| basis.initial().clone()).collect();
    for _ in 0..samples {
        let x = now.augmented();
        let mut moved = -(design.stabilizing_gain() * &x);
        let mut offset = 0;
        for (input, basis) in design.bases().iter().enumerate() {
            moved[input] += functions[input].dot(&eta.rows(offset, basis.terms()));
            functions[input] = basis.a_l() * &functions[input];
            offset += basis.terms();
        }
        now.input += &moved;
        planned.augmented.push(x);
        planned.moves.push(moved.clone());
        planned.states.push(now.measured.clone());
        planned.inputs.push(now.input.clone());
        now.increment = plant.a() * &now.increment + plant.b() * &moved;
        now.measured += &now.increment;
        now.error += plant.c() * &now.increment;
    }
    planned
}

/// Σ xᵀQx + ΔuᵀRΔu of a plan.
pub fn simulated_cost(design: &StabilizedDesign, planned: &Planned) -> f64 {
    let weights = design.weights();
    let stage = |(x, moved): (&DVector<f64>, &DVector<f64>)| {
        x.dot(&(weights.q() * x)) + moved.dot(&(weights.r() * moved))
    };
    planned.augmented.iter().zip(&planned.moves).map(stage).sum()
}

/// An optimum of V + c σ².
#[derive(Clone, Debug)]
pub struct Optimum {
    pub eta: DVector<f64>,
    pub slack: f64,
    pub cost: f64,
}

/// All bounds by limits and samples as rows G [η; σ] ≤ h; rows that no decision moves are left out.
fn rows(
    design: &StabilizedDesign,
    limits: &[SignalLimit],
    upper: &[f64],
    start: &Start,
) -> (Vec<Vec<f64>>, Vec<f64>) {
    let end = limits.iter().flat_map(|limit| &limit.samples).max().map_or(0, |last| last + 1);
    let terms: usize = design.bases().iter().map(LaguerreBasis::terms).sum();
    let planned = |eta: &DVector<f64>| simulate(design, start, eta, end);
    let free = planned(&DVector::zeros(terms));
    let each: Vec<Planned> = (0..terms)
        .map(|term| planned(&DVector::from_fn(terms, |i, _| f64::from(u8::from(i == term)))))
        .collect();
    let (mut g, mut h, mut first) = (vec![], vec![], 0);
    for limit in limits {
        let bounds = limit.directions.nrows();
        for &m in &limit.samples {
            let of = |plan: &Planned| {
                &limit.directions * (&limit.state * &plan.states[m] + &limit.input * &plan.inputs[m])
            };
            let known = of(&free);
            let columns: Vec<DVector<f64>> = each.iter().map(|plan| of(plan) - &known).collect();
            for bound in 0..bounds {
                let mut row: Vec<f64> = columns.iter().map(|column| column[bound]).collect();
                if row.iter().all(|value| *value == 0.0) {
                    continue;
                }
                row.push(-limit.relaxation);
                g.push(row);
                h.push(upper[first + bound] - known[bound]);
            }
        }
        first += bounds;
    }
    (g, h)
}

/// The program of one sample by Clarabel.
pub fn clarabel(
    design: &StabilizedDesign,
    limits: &[SignalLimit],
    slack_cost: f64,
    upper: &[f64],
    start: &Start,
) -> Option<Optimum> {
    let x = start.augmented();
    let (states, size) = (x.len(), design.cost().nrows() - x.len());
    let mut h = DMatrix::zeros(size + 1, size + 1);
    h.view_mut((0, 0), (size, size)).copy_from(&design.cost().view((states, states), (size, size)));
    h[(size, size)] = slack_cost;
    let f = (design.cost().view((states, 0), (size, states)) * &x).push(0.0);
    let scale = h.diagonal().max();
    let columns = |matrix: &[Vec<f64>]| CscMatrix::from(matrix.iter().map(Vec::as_slice));
    let triangle: Vec<Vec<f64>> =
        (h.upper_triangle() / scale).row_iter().map(|row| row.iter().copied().collect()).collect();
    let (g, bounds) = rows(design, limits, upper, start);
    let settings = DefaultSettingsBuilder::default()
        .verbose(false)
        .tol_gap_abs(1e-12)
        .tol_gap_rel(1e-12)
        .tol_feas(1e-12)
        .max_iter(500)
        .build()
        .unwrap();
    let linear: Vec<f64> = (&f / scale).iter().copied().collect();
    let cones = [NonnegativeConeT(bounds.len())];
    let mut solver =
        DefaultSolver::new(&columns(&triangle), &linear, &columns(&g), &bounds, &cones, settings).unwrap();
    solver.solve();
    if !matches!(solver.solution.status, SolverStatus::Solved | SolverStatus::AlmostSolved) {
        return None;
    }
    let eta = DVector::from_column_slice(&solver.solution.x[..size]);
    let slack = solver.solution.x[size];
    let cost = design.cost_of(&x, &eta) + slack_cost * slack * slack;
    Some(Optimum { eta, slack, cost })
}
