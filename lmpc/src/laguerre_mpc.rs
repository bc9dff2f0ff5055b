//! Laguerre MPC under limits, at run time.

use alloc::vec::Vec;

use nalgebra::{DMatrix, RowDVector, RowSVector, SMatrix, SVector};
use serde::{Deserialize, Serialize};

use crate::bounds::Bounds;
use crate::controller_state::Decision;
use crate::laguerre_walk::LaguerreWalk;
use crate::limit_row::{LimitRow, limit_rows};
use crate::model_increment::ModelIncrement;
use crate::precision::converted;
use crate::relaxable::RelaxableProgram;
use crate::{
    Controller, ControllerState, DesignError, Limit, LmpcDesign, Precision, Sample, StateFeedback, Step,
};

/// Constrained Laguerre MPC for a plant of N states, P inputs and Q outputs, with E ≥ ΣN + 1 unknowns: the
/// Laguerre coefficients and one slack.
///
/// The first move of min ηᵀΩη + 2ηᵀΨx under the limits. When the unconstrained optimum keeps them, the
/// step is one matrix–vector product; else an exact solver runs, warm-started from the last active set.
/// When no η keeps them, they are relaxed by a common slack that is charged quadratically, soft limits
/// before hard ones, and the status says so.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "T: Precision")]
pub struct LaguerreMpc<const N: usize, const P: usize, const Q: usize, const E: usize, T = f64> {
    unconstrained: StateFeedback<N, P, Q, T>,
    model_increment: Option<ModelIncrement<N, P, T>>,
    /// Ψ, E×N and E×Q, in η; zero for the slack.
    psi_state: SMatrix<T, E, N>,
    psi_output: SMatrix<T, E, Q>,
    /// L(0)ᵀ: Δu(k) = L(0)ᵀ η.
    first_move: SMatrix<T, P, E>,
    rows: Vec<KnownPart<N, P, Q, T>>,
    program: RelaxableProgram<E, T>,
}

/// What of a limit's left-hand side is known before η is chosen, and what it is at the unconstrained η.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "T: Precision")]
struct KnownPart<const N: usize, const P: usize, const Q: usize, T> {
    state: RowSVector<T, N>,
    output: RowSVector<T, Q>,
    unconstrained_state: RowSVector<T, N>,
    unconstrained_output: RowSVector<T, Q>,
    input: RowSVector<T, P>,
    step: RowSVector<T, P>,
    measured: RowSVector<T, N>,
    bound: usize,
}

/// What the limits need of one sample.
struct Known<const N: usize, const P: usize, const Q: usize, T> {
    delta: SVector<T, N>,
    error: SVector<T, Q>,
    /// u_r(k) + v(k−1)
    input: SVector<T, P>,
    /// u_r(k) − u_r(k−1)
    step: SVector<T, P>,
    measured: SVector<T, N>,
}

impl<const N: usize, const P: usize, const Q: usize, const E: usize> LaguerreMpc<N, P, Q, E> {
    /// The controller of a design under some limits.
    ///
    /// # Errors
    /// [`DesignError::Dimension`] when the sizes differ from the const generics or E is too small,
    /// [`DesignError::ElementNotFinite`], [`DesignError::NotPositiveDefinite`] (Ω with slack).
    pub fn new(design: &LmpcDesign, limits: &[Limit]) -> Result<Self, DesignError> {
        let unconstrained = StateFeedback::from_design(design)?;
        let (omega, psi) = (design.prediction().omega(), design.prediction().psi());
        let terms = omega.nrows();
        let rows = limit_rows(limits, LaguerreWalk::new(design))?;
        let program = RelaxableProgram::new(omega, &rows)?;

        let first_move = design.first_move();
        Ok(Self {
            unconstrained,
            model_increment: None,
            psi_state: SMatrix::from_fn(|i, j| if i < terms { psi[(i, j)] } else { 0.0 }),
            psi_output: SMatrix::from_fn(|i, j| if i < terms { psi[(i, N + j)] } else { 0.0 }),
            first_move: SMatrix::from_fn(|i, j| if j < terms { first_move[(i, j)] } else { 0.0 }),
            rows: rows.iter().map(|row| KnownPart::new(row, design.coefficient_gain())).collect(),
            program,
        })
    }

    /// As [`LaguerreMpc::new`], with Δx(k) from the design's model instead of the measured motion: the motion that leads
    /// to the deviation from the reference under v(k−1) + d(k). The disturbance of each sample is then its integral
    /// action.
    ///
    /// Use it under limits when an actuator answers late: in the measured motion that looks like a disturbance, which makes
    /// the closed loop oscillate while a limit is active.
    ///
    /// # Errors
    /// As [`LaguerreMpc::new`], and [`DesignError::NotFinite`] when A of the plant cannot be inverted.
    pub fn with_model_increment(design: &LmpcDesign, limits: &[Limit]) -> Result<Self, DesignError> {
        let controller = Self::new(design, limits)?;
        Ok(Self { model_increment: Some(ModelIncrement::new(design.model().plant())?), ..controller })
    }
}

impl<const N: usize, const P: usize, const Q: usize, const E: usize, T: Precision>
    LaguerreMpc<N, P, Q, E, T>
{
    /// The same controller in another precision.
    pub fn to_precision<U: Precision>(&self) -> LaguerreMpc<N, P, Q, E, U> {
        LaguerreMpc {
            unconstrained: self.unconstrained.to_precision(),
            model_increment: self.model_increment.as_ref().map(ModelIncrement::to_precision),
            psi_state: converted(&self.psi_state),
            psi_output: converted(&self.psi_output),
            first_move: converted(&self.first_move),
            rows: self.rows.iter().map(KnownPart::to_precision).collect(),
            program: self.program.to_precision(),
        }
    }

    /// The law without limits.
    pub fn unconstrained(&self) -> &StateFeedback<N, P, Q, T> {
        &self.unconstrained
    }
}

impl<
    const N: usize,
    const P: usize,
    const Q: usize,
    const E: usize,
    const W: usize,
    T: Precision,
    const K: usize,
> Controller<N, P, Q, W, T, K> for LaguerreMpc<N, P, Q, E, T>
{
    fn step(
        &self,
        state: &mut ControllerState<N, P, W, T, K>,
        sample: &Sample<'_, N, P, Q, T>,
    ) -> Step<P, T> {
        let increment = self.model_increment.as_ref().map_or(sample.increment, |model| {
            model.that_led_to(&sample.deviation, &(state.feedback() + sample.disturbance))
        });
        let sample = &Sample { increment, ..*sample };
        let known = Known {
            delta: sample.increment,
            error: sample.error,
            input: sample.input_reference + state.feedback(),
            step: sample.input_reference - state.input_reference(),
            measured: sample.measured,
        };
        if self.rows.iter().all(|row| row.holds_unconstrained(&known, sample.upper)) {
            return self.unconstrained.step(state, sample);
        }
        let f = self.psi_state * known.delta + self.psi_output * known.error;
        let rooms = Rooms { rows: &self.rows, known: &known, upper: sample.upper };
        let (solution, status) = self.program.solve(&f, &rooms, &mut state.warm_start);
        let first_move = self.first_move * solution.x;
        state.take(sample, &Decision::solved(state.feedback(), first_move, &solution, status))
    }
}

impl<const N: usize, const P: usize, const Q: usize> KnownPart<N, P, Q, f64> {
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
}

impl<const N: usize, const P: usize, const Q: usize, T: Precision> KnownPart<N, P, Q, T> {
    fn to_precision<U: Precision>(&self) -> KnownPart<N, P, Q, U> {
        KnownPart {
            state: converted(&self.state),
            output: converted(&self.output),
            unconstrained_state: converted(&self.unconstrained_state),
            unconstrained_output: converted(&self.unconstrained_output),
            input: converted(&self.input),
            step: converted(&self.step),
            measured: converted(&self.measured),
            bound: self.bound,
        }
    }

    fn upper(&self, upper: &[T]) -> T {
        upper.get(self.bound).copied().unwrap_or(T::INFINITY)
    }

    /// The known part but for \[Δx_m; y − r\].
    fn base(&self, known: &Known<N, P, Q, T>) -> T {
        (self.input * known.input + self.step * known.step + self.measured * known.measured).x
    }

    /// What the state does without further moves.
    fn drift(&self, known: &Known<N, P, Q, T>) -> T {
        (self.state * known.delta + self.output * known.error).x
    }

    fn holds_unconstrained(&self, known: &Known<N, P, Q, T>, upper: &[T]) -> bool {
        let (upper, base) = (self.upper(upper), self.base(known));
        let feedback = (self.unconstrained_state * known.delta + self.unconstrained_output * known.error).x;
        let size = upper.abs().max(base.abs()).max(feedback.abs());
        base + feedback <= upper + T::LIMIT * size
    }
}

/// What the limits leave for η at one sample.
struct Rooms<'a, const N: usize, const P: usize, const Q: usize, T> {
    rows: &'a [KnownPart<N, P, Q, T>],
    known: &'a Known<N, P, Q, T>,
    upper: &'a [T],
}

impl<const N: usize, const P: usize, const Q: usize, T: Precision> Bounds<T> for Rooms<'_, N, P, Q, T> {
    fn bound(&self, row: usize) -> T {
        let row = &self.rows[row];
        row.upper(self.upper) - row.base(self.known) - row.drift(self.known)
    }

    fn size(&self, row: usize) -> T {
        let row = &self.rows[row];
        row.upper(self.upper).abs() + row.base(self.known).abs() + row.drift(self.known).abs()
    }
}

fn part<const C: usize>(row: &RowDVector<f64>, from: usize) -> RowSVector<f64, C> {
    RowSVector::from_fn(|_, column| row[from + column])
}
