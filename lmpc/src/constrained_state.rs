//! What a controller with limits remembers, and what a step of it yields.

use nalgebra::SVector;
use serde::{Deserialize, Serialize};

use crate::relaxable::RelaxableWarmStart;
use crate::{ControllerState, Solution, Status, Step};

/// What a controller with limits remembers: also the active set of its last solution, of up to W limits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ConstrainedState<const N: usize, const P: usize, const W: usize> {
    /// As of a controller without limits.
    pub controller: ControllerState<N, P>,
    pub(crate) warm_start: RelaxableWarmStart<W>,
}

/// The outcome of a step under limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstrainedStep<const P: usize> {
    /// The input and its status.
    pub step: Step<P>,
    /// Iterations of the solver; 0 when the unconstrained optimum or the last active set was right.
    pub iterations: u32,
    /// How many limits hold with equality.
    pub active: usize,
}

impl<const N: usize, const P: usize, const W: usize> ConstrainedState<N, P, W> {
    /// Around the state of a controller without limits.
    pub fn new(controller: ControllerState<N, P>) -> Self {
        Self { controller, warm_start: RelaxableWarmStart::default() }
    }

    /// Takes over a solution and the first move that it stands for; holds the input when it is of no use.
    pub(crate) fn taken<const E: usize>(
        &mut self,
        measured: &SVector<f64, N>,
        input_reference: &SVector<f64, P>,
        first_move: SVector<f64, P>,
        solution: &Solution<E>,
        status: Status,
    ) -> ConstrainedStep<P> {
        let controller = &mut self.controller;
        let usable = matches!(status, Status::Optimal | Status::Relaxed);
        let increment = if usable { first_move } else { SVector::zeros() };
        let feedback = controller.feedback() + increment;
        let (input, status) = match controller.accept(measured, &feedback, input_reference) {
            Some(input) => (input, status),
            None => (controller.applied(), Status::Held),
        };
        let step = Step { input, integral: SVector::zeros(), status };
        ConstrainedStep { step, iterations: solution.iterations, active: solution.active }
    }
}
