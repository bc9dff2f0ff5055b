//! The run-time control law with limits.

use alloc::vec::Vec;

use nalgebra::{DMatrix, RowDVector, RowSVector, SMatrix, SVector};
use serde::{Deserialize, Serialize};

use crate::limit::{LimitRow, limit_rows};
use crate::{
    Controller, ControllerState, DesignError, Limit, LmpcDesign, Outcome, QuadraticProgram, Solution, Status,
    Step, WarmStart, validate,
};

/// Weight of the slack against the largest element of Ω: limits give way when they must, not to save cost.
const SLACK_WEIGHT: f64 = 1e4;
/// Share of the slack that hard limits get in a relaxed problem.
const HARD_SHARE: f64 = 1e-3;
/// Relative violation that rounding may leave.
const ROUNDING: f64 = 1e-9;

/// Constrained Laguerre MPC for a plant of N states, P inputs and Q outputs, with E ≥ ΣN + 1 unknowns: the
/// Laguerre coefficients and one slack.
///
/// The first move of min ηᵀΩη + 2ηᵀΨx under the limits. When the unconstrained optimum keeps them, the
/// step is one matrix–vector product; else an exact solver runs, warm-started from the last active set.
/// When no η keeps them, they are relaxed by a common slack that is charged quadratically, soft limits
/// before hard ones, and the status says so.
#[derive(Clone, Debug, PartialEq)]
pub struct ConstrainedController<const N: usize, const P: usize, const Q: usize, const E: usize> {
    unconstrained: Controller<N, P, Q>,
    /// Ψ, E×N and E×Q, in η; zero for the slack.
    psi_state: SMatrix<f64, E, N>,
    psi_output: SMatrix<f64, E, Q>,
    /// L(0)ᵀ: Δu(k) = L(0)ᵀ η.
    first_move: SMatrix<f64, P, E>,
    rows: Vec<KnownPart<N, P, Q>>,
    strict: QuadraticProgram<E>,
    relaxed: QuadraticProgram<E>,
    bounds: usize,
    iteration_limit: u32,
}

/// What of a limit's left-hand side is known before η is chosen, and what it is at the unconstrained η.
#[derive(Clone, Debug, PartialEq)]
struct KnownPart<const N: usize, const P: usize, const Q: usize> {
    state: RowSVector<f64, N>,
    output: RowSVector<f64, Q>,
    unconstrained_state: RowSVector<f64, N>,
    unconstrained_output: RowSVector<f64, Q>,
    input: RowSVector<f64, P>,
    step: RowSVector<f64, P>,
    measured: RowSVector<f64, N>,
    bound: usize,
}

/// What the limits need of one sample.
struct Sample<const N: usize, const P: usize, const Q: usize> {
    delta: SVector<f64, N>,
    error: SVector<f64, Q>,
    /// u_r(k) + v(k−1)
    input: SVector<f64, P>,
    /// u_r(k) − u_r(k−1)
    step: SVector<f64, P>,
    measured: SVector<f64, N>,
}

/// What a [`ConstrainedController`] remembers: also the active set of its last solution.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ConstrainedState<const N: usize, const P: usize, const E: usize> {
    /// As of the unconstrained controller.
    pub controller: ControllerState<N, P>,
    warm_start: WarmStart<E>,
    relaxed_warm_start: WarmStart<E>,
}

impl<const N: usize, const P: usize, const E: usize> ConstrainedState<N, P, E> {
    /// Around the state of the unconstrained controller.
    pub fn new(controller: ControllerState<N, P>) -> Self {
        Self { controller, warm_start: WarmStart::default(), relaxed_warm_start: WarmStart::default() }
    }
}

/// The outcome of a constrained step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstrainedStep<const P: usize> {
    /// The input and its status.
    pub step: Step<P>,
    /// Iterations of the solver; 0 when the unconstrained optimum or the last active set was right.
    pub iterations: u32,
    /// How many limits hold with equality.
    pub active: usize,
}

impl<const N: usize, const P: usize, const Q: usize, const E: usize> ConstrainedController<N, P, Q, E> {
    /// The controller of a design under some limits.
    ///
    /// # Errors
    /// [`DesignError::Dimension`] when the sizes differ from the const generics or E is too small,
    /// [`DesignError::NotFinite`], [`DesignError::NotPositiveDefinite`] (Ω).
    pub fn new(design: &LmpcDesign, limits: &[Limit]) -> Result<Self, DesignError> {
        let unconstrained = Controller::from_design(design, design.model().plant().c())?;
        let (omega, psi) = (design.prediction().omega(), design.prediction().psi());
        let terms = omega.nrows();
        if terms + 1 > E {
            return Err(DesignError::Dimension {
                name: "Ω with slack",
                expected: (E, E),
                actual: (terms + 1, terms + 1),
            });
        }

        // Unknowns beyond ΣN + 1 are there for the size alone: unit cost, no influence.
        let mut h = DMatrix::<f64>::identity(E, E);
        h.view_mut((0, 0), (terms, terms)).copy_from(omega);
        h[(terms, terms)] = SLACK_WEIGHT * omega.amax();

        let rows = limit_rows(design, limits)?;
        let slackless = |_: &LimitRow| 0.0;
        let slack = |row: &LimitRow| if row.soft { -1.0 } else { -HARD_SHARE };
        let strict = QuadraticProgram::new(&h, &constraint_matrix(&rows, terms, E, slackless))?;
        let relaxed = QuadraticProgram::new(&h, &constraint_matrix(&rows, terms, E, slack))?;

        let eta_gain =
            omega.clone().cholesky().ok_or(DesignError::NotPositiveDefinite { name: "Ω" })?.solve(psi);
        let mut first = crate::laguerre::InputBasis::new(design.bases()).row();
        first = first.resize(P, E, 0.0);
        Ok(Self {
            unconstrained,
            psi_state: SMatrix::from_fn(|i, j| if i < terms { psi[(i, j)] } else { 0.0 }),
            psi_output: SMatrix::from_fn(|i, j| if i < terms { psi[(i, N + j)] } else { 0.0 }),
            first_move: SMatrix::from_fn(|i, j| first[(i, j)]),
            rows: rows.iter().map(|row| KnownPart::new(row, &eta_gain)).collect(),
            strict,
            relaxed,
            bounds: limits.iter().map(|limit| limit.directions.nrows()).sum(),
            iteration_limit: 4 * (E as u32 + rows.len() as u32),
        })
    }

    /// Number of run-time bounds: one per direction of each limit, in their order.
    pub fn bounds(&self) -> usize {
        self.bounds
    }

    /// The law without limits.
    pub fn unconstrained(&self) -> &Controller<N, P, Q> {
        &self.unconstrained
    }

    /// One sample, as [`Controller::step_from`], with the values of the bounds. Bounds that are missing are
    /// no limit.
    pub fn step_from(
        &self,
        state: &mut ConstrainedState<N, P, E>,
        measured: &SVector<f64, N>,
        delta: &SVector<f64, N>,
        error: &SVector<f64, Q>,
        input_reference: &SVector<f64, P>,
        upper: &[f64],
    ) -> ConstrainedStep<P> {
        let sample = Sample {
            delta: *delta,
            error: *error,
            input: input_reference + state.controller.feedback(),
            step: input_reference - state.controller.input_reference(),
            measured: *measured,
        };
        if self.rows.iter().all(|row| row.holds_unconstrained(&sample, upper)) {
            let controller = &mut state.controller;
            let step = self.unconstrained.step_from(controller, measured, delta, error, input_reference);
            state.warm_start = WarmStart::default();
            return ConstrainedStep { step, iterations: 0, active: 0 };
        }
        let (solution, status) = self.solve(state, &sample, upper);
        self.taken(state, &sample, input_reference, &solution, status)
    }

    /// The quadratic program of one sample, relaxed if it has no solution.
    fn solve(
        &self,
        state: &mut ConstrainedState<N, P, E>,
        sample: &Sample<N, P, Q>,
        upper: &[f64],
    ) -> (Solution<E>, Status) {
        let f = self.psi_state * sample.delta + self.psi_output * sample.error;
        let bound = |row: usize| self.rows[row].room(sample, upper);
        let strict = self.strict.solve_with(&f, bound, &mut state.warm_start, self.iteration_limit);
        if strict.outcome != Outcome::Infeasible {
            return (strict, status_of(strict.outcome, Status::Optimal));
        }
        let relaxed = self.relaxed.solve_with(&f, bound, &mut state.relaxed_warm_start, self.iteration_limit);
        let iterations = strict.iterations + relaxed.iterations;
        (Solution { iterations, ..relaxed }, status_of(relaxed.outcome, Status::Relaxed))
    }

    fn taken(
        &self,
        state: &mut ConstrainedState<N, P, E>,
        sample: &Sample<N, P, Q>,
        input_reference: &SVector<f64, P>,
        solution: &Solution<E>,
        status: Status,
    ) -> ConstrainedStep<P> {
        let controller = &mut state.controller;
        let usable = matches!(status, Status::Optimal | Status::Relaxed);
        let increment = if usable { self.first_move * solution.x } else { SVector::zeros() };
        let feedback = controller.feedback() + increment;
        let step = match controller.accept(&sample.measured, &feedback, input_reference) {
            Some(input) => Step { input, integral: SVector::zeros(), status },
            None => Step { input: controller.applied(), integral: SVector::zeros(), status: Status::Held },
        };
        ConstrainedStep { step, iterations: solution.iterations, active: solution.active }
    }
}

impl<const N: usize, const P: usize, const Q: usize> KnownPart<N, P, Q> {
    fn new(row: &LimitRow, eta_gain: &DMatrix<f64>) -> Self {
        // At η = −Ω⁻¹Ψx the left-hand side is (augmented − g Ω⁻¹Ψ) x.
        let unconstrained = &row.augmented - &row.eta * eta_gain;
        Self {
            state: part(&row.augmented, 0),
            output: part(&row.augmented, N),
            unconstrained_state: part(&unconstrained, 0),
            unconstrained_output: part(&unconstrained, N),
            input: part(&row.input, 0),
            step: part(&row.step, 0),
            measured: part(&row.measured, 0),
            bound: row.bound,
        }
    }

    fn upper(&self, upper: &[f64]) -> f64 {
        upper.get(self.bound).copied().unwrap_or(f64::INFINITY)
    }

    /// The known part but for \[Δx_m; y − r\].
    fn base(&self, sample: &Sample<N, P, Q>) -> f64 {
        (self.input * sample.input + self.step * sample.step + self.measured * sample.measured).x
    }

    /// What is left for η.
    fn room(&self, sample: &Sample<N, P, Q>, upper: &[f64]) -> f64 {
        self.upper(upper) - self.base(sample) - (self.state * sample.delta + self.output * sample.error).x
    }

    fn holds_unconstrained(&self, sample: &Sample<N, P, Q>, upper: &[f64]) -> bool {
        let upper = self.upper(upper);
        let value = self.base(sample)
            + (self.unconstrained_state * sample.delta + self.unconstrained_output * sample.error).x;
        value <= upper + ROUNDING * (1.0 + libm::fabs(upper))
    }
}

fn part<const C: usize>(row: &RowDVector<f64>, from: usize) -> RowSVector<f64, C> {
    RowSVector::from_fn(|_, column| row[from + column])
}

fn status_of(outcome: Outcome, solved: Status) -> Status {
    match outcome {
        Outcome::Optimal => solved,
        // Relaxed limits can always be met; in floating point they may come out as if not.
        Outcome::IterationLimit | Outcome::Infeasible => Status::IterationLimit,
        Outcome::NotFinite => Status::Held,
    }
}

/// G of the program: the rows in η, their share of the slack, and nothing for the rest.
fn constraint_matrix(
    rows: &[LimitRow],
    terms: usize,
    unknowns: usize,
    slack: impl Fn(&LimitRow) -> f64,
) -> DMatrix<f64> {
    let mut g = DMatrix::zeros(rows.len(), unknowns);
    for (index, row) in rows.iter().enumerate() {
        g.view_mut((index, 0), (1, terms)).copy_from(&row.eta);
        g[(index, terms)] = slack(row);
    }
    debug_assert!(validate::finite("G", &g).is_ok());
    g
}
