//! The run-time control law: const-generic, allocation-free, panic-free.

use nalgebra::{DMatrix, SMatrix, SVector};
use serde::{Deserialize, Serialize};

use crate::{DesignError, LmpcDesign, validate};

/// What the plant is asked to do at one sample, with N states and P inputs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Reference<const N: usize, const P: usize> {
    /// x_r(k), the reference state.
    pub state: SVector<f64, N>,
    /// What a plant that follows the reference moves by from sample k−1 to k. Zero for a set-point: a
    /// jump of the set-point itself is *not* part of it, so that it enters through y − r alone.
    pub increment: SVector<f64, N>,
    /// u_r(k), the input that keeps the plant on the reference (feed-forward).
    pub input: SVector<f64, P>,
}

impl<const N: usize, const P: usize> Reference<N, P> {
    /// A state to go to and stay at, with the input that holds it there.
    pub fn set_point(state: SVector<f64, N>, input: SVector<f64, P>) -> Self {
        Self { state, increment: SVector::zeros(), input }
    }
}

/// How a control step ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Status {
    /// The input minimises the cost within all limits.
    Optimal,
    /// No input keeps all limits: this one minimises cost and violation together.
    Relaxed,
    /// The solver ran out of iterations: the previous input is held.
    IterationLimit,
    /// The measurement, the reference or the result was not finite: the previous input is held.
    Held,
}

/// The outcome of one control step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<const P: usize> {
    /// u(k), the input to apply. Report what was applied in truth with [`ControllerState::apply`].
    pub input: SVector<f64, P>,
    /// −K_y (y − r), the share of the integral action in Δu.
    pub integral: SVector<f64, P>,
    /// How it was found.
    pub status: Status,
}

/// All that a [`Controller`] remembers from one sample to the next.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ControllerState<const N: usize, const P: usize> {
    measured: SVector<f64, N>,
    /// v(k−1) = u(k−1) − u_r(k−1): the part of the applied input that feedback added.
    feedback: SVector<f64, P>,
    input_reference: SVector<f64, P>,
}

impl<const N: usize, const P: usize> ControllerState<N, P> {
    /// A controller that takes over a plant whose last state was `measured`, under the input `applied`
    /// of which `input_reference` was feed-forward.
    pub fn new(
        measured: SVector<f64, N>,
        applied: SVector<f64, P>,
        input_reference: SVector<f64, P>,
    ) -> Self {
        Self { measured, feedback: applied - input_reference, input_reference }
    }

    /// Reports the input that was applied in truth, so that saturation further down cannot wind the
    /// integral action up. A value that is not finite is ignored.
    pub fn apply(&mut self, applied: &SVector<f64, P>) {
        let feedback = applied - self.input_reference;
        if finite(&feedback) {
            self.feedback = feedback;
        }
    }

    /// As [`ControllerState::apply`], but an input that saturated keeps its state feedback and loses only
    /// the integral action `integral` of the step that asked for it.
    ///
    /// For inputs that saturate on kicks of a few samples: the state feedback of a kick that was cut off is
    /// still there when the state has come back, and the integral action waits.
    pub fn apply_holding_integral(&mut self, applied: &SVector<f64, P>, integral: &SVector<f64, P>) {
        let cut = applied - self.applied();
        for input in 0..P {
            // Rounding of the actuators' own arithmetic is not saturation.
            let held = self.feedback[input] - integral[input];
            if libm::fabs(cut[input]) > 1e-9 * (1.0 + libm::fabs(applied[input])) && held.is_finite() {
                self.feedback[input] = held;
            }
        }
    }

    /// Takes over what a step has found and returns the input; `None`, and no change, unless all of it is
    /// finite.
    pub(crate) fn accept(
        &mut self,
        measured: &SVector<f64, N>,
        feedback: &SVector<f64, P>,
        input_reference: &SVector<f64, P>,
    ) -> Option<SVector<f64, P>> {
        let input = input_reference + feedback;
        if !(finite(measured) && finite(&input)) {
            return None;
        }
        *self = Self { measured: *measured, feedback: *feedback, input_reference: *input_reference };
        Some(input)
    }

    /// Replaces v(k−1), for a plant whose input axes have turned since. A value that is not finite is ignored.
    pub fn turn_feedback(&mut self, turned: impl Fn(&SVector<f64, P>) -> SVector<f64, P>) {
        let feedback = turned(&self.feedback);
        if finite(&feedback) {
            self.feedback = feedback;
        }
    }

    /// v(k−1), the part of the applied input that feedback added.
    pub fn feedback(&self) -> SVector<f64, P> {
        self.feedback
    }

    /// u_r(k−1).
    pub(crate) fn input_reference(&self) -> SVector<f64, P> {
        self.input_reference
    }

    /// The last measured state, x(k−1).
    pub fn measured(&self) -> SVector<f64, N> {
        self.measured
    }

    /// The input that was applied last, u(k−1).
    pub fn applied(&self) -> SVector<f64, P> {
        self.feedback + self.input_reference
    }
}

/// The unconstrained receding-horizon law Δu = −K \[Δx_m; y − r\] in incremental form, for a plant of N
/// states, P inputs and Q outputs.
///
/// ```text
/// Δe(k) = x(k) − x(k−1) − Δx_r(k)          motion that the reference does not explain
/// Δv(k) = −K_x Δe(k) − K_y C (x(k) − x_r(k))
/// u(k)  = u_r(k) + v(k−1) + Δv(k)
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Controller<const N: usize, const P: usize, const Q: usize> {
    state_gain: SMatrix<f64, P, N>,
    output_gain: SMatrix<f64, P, Q>,
    output: SMatrix<f64, Q, N>,
}

impl<const N: usize, const P: usize, const Q: usize> Controller<N, P, Q> {
    /// From the gain K, P×(N+Q), and the output matrix C, Q×N.
    ///
    /// # Errors
    /// [`DesignError::Dimension`] when the sizes differ from the const generics,
    /// [`DesignError::NotFinite`].
    pub fn new(gain: &DMatrix<f64>, output: &DMatrix<f64>) -> Result<Self, DesignError> {
        validate::shape("K", gain, (P, N + Q))?;
        validate::shape("C", output, (Q, N))?;
        Ok(Self {
            state_gain: SMatrix::from_fn(|row, column| gain[(row, column)]),
            output_gain: SMatrix::from_fn(|row, column| gain[(row, N + column)]),
            output: SMatrix::from_fn(|row, column| output[(row, column)]),
        })
    }

    /// The controller of a design on a plant with the output matrix C.
    ///
    /// # Errors
    /// As [`Controller::new`].
    pub fn from_design(design: &LmpcDesign, output: &DMatrix<f64>) -> Result<Self, DesignError> {
        Self::new(design.gain(), output)
    }

    /// K_x, the part of the gain on Δx_m, P×N.
    pub fn state_gain(&self) -> &SMatrix<f64, P, N> {
        &self.state_gain
    }

    /// K_y, the part of the gain on y − r, P×Q.
    pub fn output_gain(&self) -> &SMatrix<f64, P, Q> {
        &self.output_gain
    }

    /// One sample: from the measured state and the reference to the input.
    pub fn step(
        &self,
        state: &mut ControllerState<N, P>,
        measured: &SVector<f64, N>,
        reference: &Reference<N, P>,
    ) -> Step<P> {
        let delta = measured - state.measured - reference.increment;
        let error = self.output * (measured - reference.state);
        self.step_from(state, measured, &delta, &error, &reference.input)
    }

    /// One sample for a plant whose differences the caller forms: as [`Controller::step`], with Δe and
    /// y − r given. `measured` is only remembered.
    pub fn step_from(
        &self,
        state: &mut ControllerState<N, P>,
        measured: &SVector<f64, N>,
        delta: &SVector<f64, N>,
        error: &SVector<f64, Q>,
        input_reference: &SVector<f64, P>,
    ) -> Step<P> {
        let integral = -(self.output_gain * error);
        let feedback = state.feedback - self.state_gain * delta + integral;
        match state.accept(measured, &feedback, input_reference) {
            Some(input) => Step { input, integral, status: Status::Optimal },
            None => Step { input: state.applied(), integral: SVector::zeros(), status: Status::Held },
        }
    }
}

fn finite<const R: usize>(vector: &SVector<f64, R>) -> bool {
    vector.iter().all(|value| value.is_finite())
}
