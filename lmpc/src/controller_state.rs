//! What a controller remembers from one sample to the next.

use nalgebra::SVector;
use serde::{Deserialize, Serialize};

use crate::kept_active_set::KeptActiveSet;
use crate::relaxable::RelaxableWarmStart;
use crate::{Precision, Sample, Solution, Status, Step};

/// All that a [`Controller`](crate::Controller) of N states and P inputs remembers from one sample to the next: the
/// last state, the last input, and the active set of its last solution, of up to W limits. A law without limits
/// needs no room for them: W = 0.
///
/// With K > 0 it also keeps what a [`StabilizedMpc`](crate::StabilizedMpc) of up to K unknowns has factorised, about 16 K² bytes in double
/// precision, so that the next sample need not do it again. That changes no result; it is neither compared nor saved.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "T: Precision")]
pub struct ControllerState<const N: usize, const P: usize, const W: usize = 0, T = f64, const K: usize = 0> {
    measured: SVector<T, N>,
    /// v(k−1) = u(k−1) − u_r(k−1): the part of the applied input that feedback added.
    feedback: SVector<T, P>,
    input_reference: SVector<T, P>,
    pub(crate) warm_start: RelaxableWarmStart<W>,
    #[serde(skip)]
    pub(crate) kept: KeptActiveSet<K, T>,
}

impl<const N: usize, const P: usize, const W: usize, T: Precision> ControllerState<N, P, W, T> {
    /// A controller that takes over a plant whose last state was `measured`, under the input `applied`
    /// of which `input_reference` was feed-forward.
    pub fn new(measured: SVector<T, N>, applied: SVector<T, P>, input_reference: SVector<T, P>) -> Self {
        Self {
            measured,
            feedback: applied - input_reference,
            input_reference,
            warm_start: RelaxableWarmStart::default(),
            kept: KeptActiveSet::default(),
        }
    }

    /// A controller that takes over a plant at rest at x = 0 under no input.
    pub fn at_rest() -> Self {
        Self::new(SVector::zeros(), SVector::zeros(), SVector::zeros())
    }
}

impl<const N: usize, const P: usize, const W: usize, T: Precision, const K: usize>
    ControllerState<N, P, W, T, K>
{
    /// The same memory with room for the factors of programs of up to `UNKNOWNS` unknowns; zero for none.
    pub fn keeping<const UNKNOWNS: usize>(self) -> ControllerState<N, P, W, T, UNKNOWNS> {
        let Self { measured, feedback, input_reference, warm_start, .. } = self;
        ControllerState { measured, feedback, input_reference, warm_start, kept: KeptActiveSet::default() }
    }

    /// Reports the input that was applied in truth, so that saturation further down cannot wind the
    /// integral action up. A value that is not finite is ignored.
    pub fn apply(&mut self, applied: &SVector<T, P>) {
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
    pub fn apply_holding_integral(&mut self, applied: &SVector<T, P>, integral: &SVector<T, P>) {
        let cut = applied - self.applied();
        for input in 0..P {
            // Rounding of the actuators' own arithmetic is not saturation.
            let held = self.feedback[input] - integral[input];
            if cut[input].abs() > T::ACTUATORS * (T::one() + applied[input].abs()) && held.is_finite() {
                self.feedback[input] = held;
            }
        }
    }

    /// Replaces v(k−1), for a plant whose input axes have turned since, or for a law that takes over in flight. A value that is not
    /// finite is ignored.
    pub fn turn_feedback(&mut self, turned: impl Fn(&SVector<T, P>) -> SVector<T, P>) {
        let feedback = turned(&self.feedback);
        if finite(&feedback) {
            self.feedback = feedback;
        }
    }

    /// Puts the memory into other coordinates of the state and of the input.
    pub fn turn(
        &mut self,
        state: impl Fn(&SVector<T, N>) -> SVector<T, N>,
        input: impl Fn(&SVector<T, P>) -> SVector<T, P>,
    ) {
        self.measured = state(&self.measured);
        self.feedback = input(&self.feedback);
        self.input_reference = input(&self.input_reference);
    }

    /// v(k−1), the part of the applied input that feedback added.
    pub fn feedback(&self) -> SVector<T, P> {
        self.feedback
    }

    /// u_r(k−1), the part that was feed-forward.
    pub fn input_reference(&self) -> SVector<T, P> {
        self.input_reference
    }

    /// The last measured state, x(k−1).
    pub fn measured(&self) -> SVector<T, N> {
        self.measured
    }

    /// The input that was applied last, u(k−1).
    pub fn applied(&self) -> SVector<T, P> {
        self.feedback + self.input_reference
    }

    /// Takes over what a law has decided at a sample and says so; holds the input if any of it is not finite.
    pub(crate) fn take<const Q: usize>(
        &mut self,
        sample: &Sample<'_, N, P, Q, T>,
        decision: &Decision<P, T>,
    ) -> Step<P, T> {
        let before = self.applied();
        let accepted = finite(&sample.measured) && finite(&(sample.input_reference + decision.feedback));
        if accepted {
            self.measured = sample.measured;
            self.feedback = decision.feedback;
            self.input_reference = sample.input_reference;
        }
        let input = self.applied();
        Step {
            input,
            increment: input - before,
            integral: if accepted { decision.integral } else { SVector::zeros() },
            status: if accepted { decision.status } else { Status::Held },
            iterations: decision.iterations,
            active: decision.active,
        }
    }
}

/// What a law has decided at a sample.
pub(crate) struct Decision<const P: usize, T> {
    /// v(k), what feedback adds to the input.
    feedback: SVector<T, P>,
    integral: SVector<T, P>,
    status: Status,
    iterations: u32,
    active: usize,
}

impl<const P: usize, T: Precision> Decision<P, T> {
    /// Feedback v(k) from a gain, `integral` of which is the integral action of this sample.
    pub(crate) fn linear(feedback: SVector<T, P>, integral: SVector<T, P>) -> Self {
        Self { feedback, integral, status: Status::Optimal, iterations: 0, active: 0 }
    }

    /// Feedback v(k) from a program with `active` limits.
    pub(crate) fn program(feedback: SVector<T, P>, status: Status, iterations: u32, active: usize) -> Self {
        Self { feedback, integral: SVector::zeros(), status, iterations, active }
    }

    /// The first move Δv that a solution stands for, on top of v(k−1); none if the solution is of no use.
    pub(crate) fn solved<const E: usize>(
        previous: SVector<T, P>,
        first_move: SVector<T, P>,
        solution: &Solution<E, T>,
        status: Status,
    ) -> Self {
        let usable = matches!(status, Status::Optimal | Status::Relaxed);
        let increment = if usable { first_move } else { SVector::zeros() };
        Self {
            feedback: previous + increment,
            integral: SVector::zeros(),
            status,
            iterations: solution.iterations,
            active: solution.active,
        }
    }
}

fn finite<const R: usize, T: Precision>(vector: &SVector<T, R>) -> bool {
    vector.iter().all(|value| value.is_finite())
}
