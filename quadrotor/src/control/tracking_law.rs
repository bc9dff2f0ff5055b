//! One controller of the cascade, of whatever kind, on a model of N states and P inputs.

use alloc::vec::Vec;

use lmpc::{
    Augmented, Controller, ControllerState, DesignError, Dlqr, Limit, LmpcDesign, Quantity, Sample,
    SignalLimit, StabilizedDesign, StabilizedMpc, StateFeedback, StateSpaceMpc, StateSpaceMpcDesign,
    StateSpaceMpcWeights, Step, Weights,
};
use nalgebra::{DMatrix, SVector};

use crate::design::capacities::FEW_TERMS;
use crate::{ControllerKind, ControllerSettings};

/// A controller with room for S unknowns, or L when it needs more.
#[derive(Clone, Debug, PartialEq)]
#[allow(clippy::large_enum_variant)] // A design is made once and holds one of each loop.
pub(crate) enum TrackingLaw<const N: usize, const P: usize, const S: usize, const L: usize> {
    /// Laguerre MPC with few terms.
    FewTerms(StabilizedMpc<N, P, P, S>),
    /// Laguerre MPC with many.
    ManyTerms(StabilizedMpc<N, P, P, L>),
    /// State-space MPC.
    StateSpace(StateSpaceMpc<N, P, P, L>),
    /// The regulator, or the paper's Laguerre MPC without limits.
    Linear(StateFeedback<N, P, P>),
}

impl<const N: usize, const P: usize, const S: usize, const L: usize> TrackingLaw<N, P, S, L> {
    /// The controller of this kind with the weights of a finished Laguerre design, without limits.
    pub(crate) fn new(
        kind: ControllerKind,
        settings: &ControllerSettings<P>,
        design: &LmpcDesign,
        weights: &Weights,
    ) -> Result<Self, DesignError> {
        match kind {
            ControllerKind::Lmpc => Self::of_gain(design.gain()),
            ControllerKind::StateSpaceMpc => {
                let design = state_space(settings, design.model(), weights, design.dlqr())?;
                Ok(Self::StateSpace(StateSpaceMpc::new(&design, &[])?))
            }
            ControllerKind::Dlqr => Self::of_gain(design.dlqr().gain()),
        }
    }

    /// By a gain K on \[Δx; y − r\].
    pub(crate) fn of_gain(gain: &DMatrix<f64>) -> Result<Self, DesignError> {
        Ok(Self::Linear(StateFeedback::new(gain)?))
    }

    /// The controller of this kind with the weights of a stabilized Laguerre design under limits. A slack of 1 costs `slack_cost`.
    pub(crate) fn stabilized(
        kind: ControllerKind,
        settings: &ControllerSettings<P>,
        design: &StabilizedDesign,
        limits: &[SignalLimit],
        slack_cost: f64,
    ) -> Result<Self, DesignError> {
        Ok(match kind {
            ControllerKind::Lmpc if settings.terms as usize <= FEW_TERMS => {
                Self::FewTerms(StabilizedMpc::new(design, limits, slack_cost)?)
            }
            ControllerKind::Lmpc => Self::ManyTerms(StabilizedMpc::new(design, limits, slack_cost)?),
            ControllerKind::StateSpaceMpc => {
                let limits: Vec<Limit> = limits.iter().map(plain).collect();
                let design = state_space(settings, design.model(), design.weights(), design.dlqr())?;
                Self::StateSpace(StateSpaceMpc::new(&design, &limits)?)
            }
            ControllerKind::Dlqr => Self::of_gain(design.dlqr().gain())?,
        })
    }

    /// The regulator, which knows no limits; `None` of the others.
    pub(crate) fn regulator(&self) -> Option<&StateFeedback<N, P, P>> {
        match self {
            Self::Linear(regulator) => Some(regulator),
            _ => None,
        }
    }

    /// Whether it goes by the deviation from its reference alone, and by neither increments nor output errors.
    pub(crate) fn sees_deviation_alone(&self) -> bool {
        matches!(self, Self::StateSpace(_))
    }

    /// By how much the motion of the reference moves what a law foresees, in the room for that; `None` of a law that foresees no absolute
    /// signals.
    pub(crate) fn moved<'a>(
        &self,
        room: &'a mut [f64],
        ahead: impl Fn(usize) -> (SVector<f64, N>, SVector<f64, P>),
    ) -> Option<&'a [f64]> {
        match self {
            Self::FewTerms(law) => law.moved(room, ahead),
            Self::ManyTerms(law) => law.moved(room, ahead),
            Self::StateSpace(_) | Self::Linear(_) => None,
        }
    }

    /// How many signals a law foresees, absolute ones.
    pub(crate) fn moved_signals(&self) -> usize {
        match self {
            Self::FewTerms(law) => law.moved_signals(),
            Self::ManyTerms(law) => law.moved_signals(),
            Self::StateSpace(_) | Self::Linear(_) => 0,
        }
    }

    /// Whether it plans under limits how an increment goes on.
    pub(crate) fn plans_increments(&self) -> bool {
        matches!(self, Self::FewTerms(_) | Self::ManyTerms(_))
    }

    /// What a law under limits asks for beside its plan when an increment comes to it that the plan need not foresee: −K Δx.
    pub(crate) fn answer_to(&self, increment: &SVector<f64, N>) -> SVector<f64, P> {
        match self {
            Self::FewTerms(law) => law.unconstrained().state_gain() * -increment,
            Self::ManyTerms(law) => law.unconstrained().state_gain() * -increment,
            Self::StateSpace(_) | Self::Linear(_) => SVector::zeros(),
        }
    }

    /// One sample.
    pub(crate) fn step(
        &self,
        state: &mut ControllerState<N, P, L, f64, S>,
        sample: &Sample<'_, N, P, P>,
    ) -> Step<P> {
        self.controller().step(state, sample)
    }

    fn controller(&self) -> &dyn Controller<N, P, P, L, f64, S> {
        match self {
            Self::FewTerms(controller) => controller,
            Self::ManyTerms(controller) => controller,
            Self::StateSpace(controller) => controller,
            Self::Linear(controller) => controller,
        }
    }
}

/// The same limit for a state-space MPC. One of a signal that mixes state and input is not placed.
pub(crate) fn plain(limit: &SignalLimit) -> Limit {
    let of_input = limit.state.amax() == 0.0;
    let of_state = limit.input.amax() == 0.0;
    Limit {
        quantity: if of_input { Quantity::Input } else { Quantity::State },
        directions: if of_input {
            &limit.directions * &limit.input
        } else {
            &limit.directions * &limit.state
        },
        samples: if of_input || of_state { limit.samples.clone() } else { Vec::new() },
        soft: !of_input,
    }
}

/// State-space MPC with the same weights, and the regulator's cost of what comes after the horizon.
fn state_space<const P: usize>(
    settings: &ControllerSettings<P>,
    model: &Augmented,
    weights: &Weights,
    regulator: &Dlqr,
) -> Result<StateSpaceMpcDesign, DesignError> {
    let weights = StateSpaceMpcWeights::of_augmented(model, weights, Some(regulator.cost().clone()))?;
    let (horizon, moves) = (settings.prediction_horizon as usize, settings.control_horizon as usize);
    StateSpaceMpcDesign::with_weights(model.plant(), &weights, horizon, moves)
}
