//! The run-time control law with limits.

use alloc::vec::Vec;

use nalgebra::{DMatrix, RowDVector, RowSVector, SMatrix, SVector};

use crate::laguerre_walk::LaguerreWalk;
use crate::limit_row::{LimitRow, limit_rows};
use crate::relaxable::{RelaxableProgram, RelaxableWarmStart};
use crate::{ConstrainedState, ConstrainedStep, Controller, DesignError, Limit, LmpcDesign};

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
    program: RelaxableProgram<E>,
    bounds: usize,
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

impl<const N: usize, const P: usize, const Q: usize, const E: usize> ConstrainedController<N, P, Q, E> {
    /// The controller of a design under some limits.
    ///
    /// # Errors
    /// [`DesignError::Dimension`] when the sizes differ from the const generics or E is too small,
    /// [`DesignError::NotFinite`], [`DesignError::NotPositiveDefinite`] (Ω with slack).
    pub fn new(design: &LmpcDesign, limits: &[Limit]) -> Result<Self, DesignError> {
        let unconstrained = Controller::from_design(design, design.model().plant().c())?;
        let (omega, psi) = (design.prediction().omega(), design.prediction().psi());
        let terms = omega.nrows();
        let rows = limit_rows(limits, LaguerreWalk::new(design))?;
        let soft: Vec<bool> = rows.iter().map(|row| row.soft).collect();
        let mut g = DMatrix::zeros(rows.len(), terms);
        for (index, row) in rows.iter().enumerate() {
            g.set_row(index, &row.decision);
        }
        let program = RelaxableProgram::new(omega, &g, &soft)?;

        let first_move = design.first_move();
        Ok(Self {
            unconstrained,
            psi_state: SMatrix::from_fn(|i, j| if i < terms { psi[(i, j)] } else { 0.0 }),
            psi_output: SMatrix::from_fn(|i, j| if i < terms { psi[(i, N + j)] } else { 0.0 }),
            first_move: SMatrix::from_fn(|i, j| if j < terms { first_move[(i, j)] } else { 0.0 }),
            rows: rows.iter().map(|row| KnownPart::new(row, design.coefficient_gain())).collect(),
            program,
            bounds: limits.iter().map(|limit| limit.directions.nrows()).sum(),
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
    pub fn step_from<const W: usize>(
        &self,
        state: &mut ConstrainedState<N, P, W>,
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
            state.warm_start = RelaxableWarmStart::default();
            return ConstrainedStep { step, iterations: 0, active: 0 };
        }
        let f = self.psi_state * sample.delta + self.psi_output * sample.error;
        let bound = |row: usize| self.rows[row].room(&sample, upper);
        let (solution, status) = self.program.solve(&f, bound, &mut state.warm_start);
        state.taken(measured, input_reference, self.first_move * solution.x, &solution, status)
    }
}

impl<const N: usize, const P: usize, const Q: usize> KnownPart<N, P, Q> {
    fn new(row: &LimitRow, coefficient_gain: &DMatrix<f64>) -> Self {
        // At η = −Ω⁻¹Ψx the left-hand side is (known − g Ω⁻¹Ψ) x.
        let unconstrained = row.known.columns(0, N + Q) - &row.decision * coefficient_gain;
        Self {
            state: part(&row.known, 0),
            output: part(&row.known, N),
            unconstrained_state: part(&unconstrained, 0),
            unconstrained_output: part(&unconstrained, N),
            input: part(&row.known, N + Q),
            step: part(&row.known, N + Q + P),
            measured: part(&row.known, N + Q + 2 * P),
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
