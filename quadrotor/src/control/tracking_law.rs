//! One controller of the cascade, of whatever kind, on a model of N states and P inputs.

use alloc::vec::Vec;

use lmpc::{
    Controller, ControllerState, DesignError, DeviationFeedback, LaguerreMpc, Limit, LmpcDesign, Quantity,
    Sample, SignalLimit, StabilizedDesign, StabilizedMpc, StateFeedback, StateSpaceMpc, StateSpaceMpcDesign,
    StateSpaceMpcWeights, Step,
};
use nalgebra::{DMatrix, SVector};

use crate::design::capacities::FEW_TERMS;
use crate::{ControllerKind, ControllerSettings};

/// A controller with room for S unknowns, or L when it needs more.
#[derive(Clone, Debug, PartialEq)]
#[allow(clippy::large_enum_variant)] // A design is made once and holds one of each loop.
pub(crate) enum TrackingLaw<const N: usize, const P: usize, const S: usize, const L: usize> {
    /// Laguerre MPC with few terms.
    FewTerms(LaguerreMpc<N, P, P, S>),
    /// Laguerre MPC with many.
    ManyTerms(LaguerreMpc<N, P, P, L>),
    /// Laguerre MPC about a stabilizing feedback, with few terms.
    StabilizedFew(StabilizedMpc<N, P, P, S>),
    /// The same with many.
    StabilizedMany(StabilizedMpc<N, P, P, L>),
    /// State-space MPC.
    StateSpace(StateSpaceMpc<N, P, P, L>),
    /// Laguerre MPC without limits, or the regulator: increments from the measured motion, which contains what
    /// disturbs it.
    Incremental(StateFeedback<N, P, P>),
    /// The regulator by the deviation from its reference, told of what disturbs it.
    ByDeviation(DeviationFeedback<N, P, P>),
}

impl<const N: usize, const P: usize, const S: usize, const L: usize> TrackingLaw<N, P, S, L> {
    /// The controller of this kind with the weights of a finished Laguerre design, without limits.
    pub(crate) fn new(
        kind: ControllerKind,
        settings: &ControllerSettings<P>,
        design: &LmpcDesign,
        limits: &[Limit],
    ) -> Result<Self, DesignError> {
        Ok(match kind {
            ControllerKind::Lmpc if limits.is_empty() => {
                Self::Incremental(StateFeedback::from_design(design)?)
            }
            // Under limits it goes by the motion that the model explains: in the measured motion an actuator that answers
            // late looks like a disturbance.
            ControllerKind::Lmpc if settings.terms as usize <= FEW_TERMS => {
                Self::FewTerms(LaguerreMpc::with_model_increment(design, limits)?)
            }
            ControllerKind::Lmpc => Self::ManyTerms(LaguerreMpc::with_model_increment(design, limits)?),
            ControllerKind::StateSpaceMpc => {
                Self::StateSpace(StateSpaceMpc::new(&state_space_of(settings, design)?, limits)?)
            }
            ControllerKind::Dlqr => Self::Incremental(StateFeedback::new(design.dlqr().gain())?),
        })
    }

    /// Increments of the measured motion by a gain K on \[Δx; y − r\].
    pub(crate) fn of_gain(gain: &DMatrix<f64>) -> Result<Self, DesignError> {
        Ok(Self::Incremental(StateFeedback::new(gain)?))
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
                Self::StabilizedFew(StabilizedMpc::new(design, limits, slack_cost)?)
            }
            ControllerKind::Lmpc => Self::StabilizedMany(StabilizedMpc::new(design, limits, slack_cost)?),
            ControllerKind::StateSpaceMpc => {
                let limits: Vec<Limit> = limits.iter().map(plain).collect();
                Self::StateSpace(StateSpaceMpc::new(&state_space(settings, design)?, &limits)?)
            }
            ControllerKind::Dlqr => Self::Incremental(StateFeedback::new(design.dlqr().gain())?),
        })
    }

    /// The regulator of a design, by the deviation from its reference.
    pub(crate) fn by_deviation(design: &LmpcDesign) -> Result<Self, DesignError> {
        let regulator = DeviationFeedback::new(design.model().plant(), design.dlqr().gain())?;
        Ok(Self::ByDeviation(regulator))
    }

    /// Whether it goes by the measured motion; else it must be told of disturbances.
    pub(crate) fn is_incremental(&self) -> bool {
        matches!(self, Self::Incremental(_) | Self::StabilizedFew(_) | Self::StabilizedMany(_))
    }

    /// Whether it goes by the deviation from its reference alone, and by neither increments nor output errors.
    pub(crate) fn sees_deviation_alone(&self) -> bool {
        matches!(self, Self::StateSpace(_))
    }

    /// The part of a reference's motion that its limits of states do not count: those of a state-space MPC bound
    /// the deviation from the reference instead of the state.
    pub(crate) fn uncounted(&self, reference: &SVector<f64, P>) -> SVector<f64, P> {
        if matches!(self, Self::StateSpace(_)) { *reference } else { SVector::zeros() }
    }

    /// One sample.
    pub(crate) fn step(&self, state: &mut ControllerState<N, P, L>, sample: &Sample<'_, N, P, P>) -> Step<P> {
        self.controller().step(state, sample)
    }

    fn controller(&self) -> &dyn Controller<N, P, P, L> {
        match self {
            Self::FewTerms(controller) => controller,
            Self::ManyTerms(controller) => controller,
            Self::StabilizedFew(controller) => controller,
            Self::StabilizedMany(controller) => controller,
            Self::StateSpace(controller) => controller,
            Self::Incremental(controller) => controller,
            Self::ByDeviation(controller) => controller,
        }
    }
}

/// The same limit for a state-space MPC. One of a signal that mixes state and input is not placed.
fn plain(limit: &SignalLimit) -> Limit {
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
    design: &StabilizedDesign,
) -> Result<StateSpaceMpcDesign, DesignError> {
    let (q, states) = (design.weights().q(), design.model().plant().states());
    let weights = StateSpaceMpcWeights {
        output: q.view((states, states), (P, P)).into_owned(),
        moves: design.weights().r().clone(),
        increment: q.view((0, 0), (states, states)).into_owned(),
        terminal: Some(design.dlqr().cost().clone()),
    };
    let (horizon, moves) = (settings.prediction_horizon as usize, settings.control_horizon as usize);
    StateSpaceMpcDesign::with_weights(design.model().plant(), &weights, horizon, moves)
}

/// State-space MPC with the same weights: Q on y − r and on the increments of the rates, R on the moves, and the
/// regulator's cost of what comes after the horizon.
fn state_space_of<const P: usize>(
    settings: &ControllerSettings<P>,
    design: &LmpcDesign,
) -> Result<StateSpaceMpcDesign, DesignError> {
    let diagonal =
        |weights: &SVector<f64, P>| DMatrix::from_fn(P, P, |i, j| if i == j { weights[i] } else { 0.0 });
    let states = design.model().plant().states();
    let mut damping = DMatrix::zeros(states, states);
    for (channel, weight) in settings.rate_weight.iter().enumerate() {
        let rate = channel * (states / P) + 1;
        damping[(rate, rate)] = *weight;
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
