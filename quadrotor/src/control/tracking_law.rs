//! One controller of the cascade, of whatever kind, on a model of N states and P inputs.

use lmpc::{
    ConstrainedController, ConstrainedState, ConstrainedStep, Controller, DesignError, Limit, LmpcDesign,
    StateSpace, StateSpaceMpc, StateSpaceMpcDesign, StateSpaceMpcSample, StateSpaceMpcWeights,
};
use nalgebra::{DMatrix, SMatrix, SVector};

use crate::{ControllerKind, ControllerSettings};

/// Laguerre terms per input that programs of the smaller size have room for.
const SMALL_TERMS: u32 = 7;

/// A controller with room for S unknowns, or L when it needs more: one more than the terms or moves of all its
/// inputs together.
#[derive(Clone, Debug, PartialEq)]
#[allow(clippy::large_enum_variant)] // A design is made once and holds one of each loop.
pub(crate) enum TrackingLaw<const N: usize, const P: usize, const S: usize, const L: usize> {
    /// Laguerre MPC with few terms.
    Lmpc(ConstrainedController<N, P, P, S>, Motion<N, P>),
    /// Laguerre MPC with many.
    LargeLmpc(ConstrainedController<N, P, P, L>, Motion<N, P>),
    /// State-space MPC.
    StateSpace(StateSpaceMpc<N, P, P, L>),
    /// Laguerre MPC without limits, or the regulator: increments from the measured motion, which contains what
    /// disturbs it.
    Incremental(Controller<N, P, P>),
}

/// Δx that leads to a state under a driving input: x − A⁻¹(x − B u). Under limits it stands for the measured
/// motion, in which an actuator that answers late looks like a disturbance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Motion<const N: usize, const P: usize> {
    /// I − A⁻¹
    by_state: SMatrix<f64, N, N>,
    /// A⁻¹ B
    by_input: SMatrix<f64, N, P>,
}

impl<const N: usize, const P: usize> Motion<N, P> {
    fn new(plant: &StateSpace) -> Result<Self, DesignError> {
        let inverse = plant.a().clone().try_inverse().ok_or(DesignError::NotFinite { name: "A⁻¹" })?;
        let by_input = &inverse * plant.b();
        let by_state = DMatrix::identity(N, N) - inverse;
        Ok(Self {
            by_state: SMatrix::from_fn(|i, j| by_state[(i, j)]),
            by_input: SMatrix::from_fn(|i, j| by_input[(i, j)]),
        })
    }
}

impl<const N: usize, const P: usize> Motion<N, P> {
    fn that_led_to<const L: usize>(
        &self,
        state: &ConstrainedState<N, P, L>,
        sample: &TrackingSample<N, P>,
    ) -> SVector<f64, N> {
        let driving = state.controller.feedback() + sample.disturbance;
        self.by_state * sample.deviation + self.by_input * driving
    }
}

/// What a controller is told at one sample.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TrackingSample<const N: usize, const P: usize> {
    /// The measured state.
    pub(crate) measured: SVector<f64, N>,
    /// How it moved since the last sample, less what the reference explains: what an incremental law goes by.
    pub(crate) delta: SVector<f64, N>,
    /// Its deviation from the reference; y − r are its even elements.
    pub(crate) deviation: SVector<f64, N>,
    /// Feed-forward.
    pub(crate) input_reference: SVector<f64, P>,
    /// Estimated disturbance, as if added to the input.
    pub(crate) disturbance: SVector<f64, P>,
}

impl<const N: usize, const P: usize> TrackingSample<N, P> {
    /// y − r, for states y₁ ẏ₁ y₂ ẏ₂ ….
    fn error(&self) -> SVector<f64, P> {
        SVector::from_fn(|output, _| self.deviation[2 * output])
    }
}

impl<const N: usize, const P: usize, const S: usize, const L: usize> TrackingLaw<N, P, S, L> {
    /// The controller of this kind with the weights of a finished Laguerre design.
    pub(crate) fn new(
        kind: ControllerKind,
        settings: &ControllerSettings<P>,
        design: &LmpcDesign,
        limits: &[Limit],
    ) -> Result<Self, DesignError> {
        let plant = design.model().plant();
        Ok(match kind {
            ControllerKind::Lmpc if limits.is_empty() => {
                Self::Incremental(Controller::from_design(design, plant.c())?)
            }
            ControllerKind::Lmpc if settings.terms <= SMALL_TERMS => {
                Self::Lmpc(ConstrainedController::new(design, limits)?, Motion::new(plant)?)
            }
            ControllerKind::Lmpc => {
                Self::LargeLmpc(ConstrainedController::new(design, limits)?, Motion::new(plant)?)
            }
            ControllerKind::StateSpaceMpc => {
                Self::StateSpace(StateSpaceMpc::new(&state_space(settings, design)?, limits)?)
            }
            ControllerKind::Dlqr => Self::Incremental(Controller::new(design.dlqr().gain(), plant.c())?),
        })
    }

    /// Whether it goes by the measured motion; else it must be told of disturbances.
    pub(crate) fn is_incremental(&self) -> bool {
        matches!(self, Self::Incremental(_))
    }

    /// Whether its limits of states bound the deviation from the reference instead of the state.
    pub(crate) fn bounds_deviations(&self) -> bool {
        matches!(self, Self::StateSpace(_))
    }

    /// One sample under limits of the values `upper`.
    pub(crate) fn step(
        &self,
        state: &mut ConstrainedState<N, P, L>,
        sample: &TrackingSample<N, P>,
        upper: &[f64],
    ) -> ConstrainedStep<P> {
        let TrackingSample { measured, input_reference, .. } = sample;
        match self {
            Self::Lmpc(law, motion) => {
                let delta = motion.that_led_to(state, sample);
                law.step_from(state, measured, &delta, &sample.error(), input_reference, upper)
            }
            Self::LargeLmpc(law, motion) => {
                let delta = motion.that_led_to(state, sample);
                law.step_from(state, measured, &delta, &sample.error(), input_reference, upper)
            }
            Self::StateSpace(law) => {
                let seen = StateSpaceMpcSample {
                    state: sample.deviation,
                    input_reference: *input_reference,
                    disturbance: sample.disturbance,
                };
                law.step(state, &seen, &[], upper)
            }
            Self::Incremental(law) => {
                let controller = &mut state.controller;
                let step =
                    law.step_from(controller, measured, &sample.delta, &sample.error(), input_reference);
                ConstrainedStep { step, iterations: 0, active: 0 }
            }
        }
    }
}

/// State-space MPC with the same weights: Q on y − r and on the increments of the rates, R on the moves, and the
/// regulator's cost of what comes after the horizon.
fn state_space<const P: usize>(
    settings: &ControllerSettings<P>,
    design: &LmpcDesign,
) -> Result<StateSpaceMpcDesign, DesignError> {
    let diagonal =
        |weights: &SVector<f64, P>| DMatrix::from_fn(P, P, |i, j| if i == j { weights[i] } else { 0.0 });
    let mut damping = DMatrix::zeros(2 * P, 2 * P);
    for (channel, weight) in settings.rate_weight.iter().enumerate() {
        damping[(2 * channel + 1, 2 * channel + 1)] = *weight;
    }
    let weights = StateSpaceMpcWeights {
        output: diagonal(&settings.output_weight),
        moves: diagonal(&settings.increment_weight),
        increment: damping,
        terminal: Some(design.dlqr().cost().clone()),
    };
    let (horizon, moves) = (settings.prediction_horizon as usize, settings.control_horizon as usize);
    StateSpaceMpcDesign::with_weights(design.model().plant(), &weights, horizon, moves)
}
