//! The controllers that fly a step on one axis.

use lmpc::{
    Augmented, Controller as _, ControllerState, DesignError, Dlqr, LaguerreBasis, LaguerreMpc, LmpcDesign,
    StateSpaceMpc, StateSpaceMpcDesign, StateSpaceMpcWeights, Step, Weighting,
};
use nalgebra::{Vector1, Vector2, dmatrix};

use super::axis::Axis;

/// What a controller sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// y and ẏ.
    pub state: [f64; 2],
    /// Their increments since the last sample.
    pub delta: [f64; 2],
    /// r.
    pub goal: f64,
}

/// What it does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Move {
    /// u(k).
    pub input: f64,
    /// Iterations of the solver.
    pub iterations: u32,
    /// Whether limits were active.
    pub limited: bool,
}

/// A controller with what it remembers.
pub type Controller = Box<dyn FnMut(&Sample) -> Move + Send>;

/// Samples that limits are placed on.
pub type Placing<'a> = &'a [usize];

/// Laguerre MPC of an axis, with E ≥ N + 1.
///
/// # Errors
/// As [`LmpcDesign::new`] and [`LaguerreMpc::new`].
pub fn laguerre<const E: usize>(
    axis: &Axis,
    terms: usize,
    scale: f64,
    weighting: Weighting,
    placing: Placing<'_>,
) -> Result<Controller, DesignError> {
    let model = Augmented::new(&axis.model()?);
    let weights = axis.weights(&model)?;
    let design =
        LmpcDesign::new(&model, &weights, &[LaguerreBasis::new(terms, scale)?], axis.horizon, weighting)?;
    // A Laguerre function moves for ever, pulses (a = 0) do not.
    let moves = if scale == 0.0 { terms } else { usize::MAX };
    let (limits, bounds) = axis.limits(placing, moves);
    let controller = LaguerreMpc::<2, 1, 1, E>::new(&design, &limits)?;
    let mut state = ControllerState::<2, 1, E>::at_rest();
    Ok(Box::new(move |sample| {
        let now = lmpc::Sample {
            measured: sample.state.into(),
            increment: sample.delta.into(),
            error: Vector1::new(sample.state[0] - sample.goal),
            upper: &bounds,
            ..lmpc::Sample::default()
        };
        moved(&controller.step(&mut state, &now))
    }))
}

/// What a state-space MPC counts at the end of its horizon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// Nothing, as in (34).
    Nothing,
    /// What the regulator would still cost.
    Riccati,
}

/// State-space MPC of an axis with one unknown per move, with E ≥ N_c + 1.
///
/// # Errors
/// As [`StateSpaceMpcDesign::with_weights`] and [`StateSpaceMpc::new`].
pub fn state_space<const E: usize>(
    axis: &Axis,
    moves: usize,
    end: End,
    placing: Placing<'_>,
) -> Result<Controller, DesignError> {
    let design = state_space_design(axis, moves, end)?;
    let (limits, bounds) = axis.limits(placing, moves);
    let controller = StateSpaceMpc::<2, 1, 1, E>::new(&design, &limits)?;
    let mut state = ControllerState::<2, 1, E>::at_rest();
    Ok(Box::new(move |sample| {
        // The goal as the origin: nothing to preview, which would cost time for the same move.
        let [y, rate] = sample.state;
        let deviation = Vector2::new(y - sample.goal, rate);
        let now = lmpc::Sample { deviation, upper: &bounds, ..lmpc::Sample::default() };
        moved(&controller.step(&mut state, &now))
    }))
}

/// Its design.
pub fn state_space_design(axis: &Axis, moves: usize, end: End) -> Result<StateSpaceMpcDesign, DesignError> {
    let weights = StateSpaceMpcWeights {
        output: dmatrix![axis.output_weight],
        moves: dmatrix![axis.increment_weight],
        increment: dmatrix![0.0, 0.0; 0.0, axis.rate_weight],
        terminal: match end {
            End::Nothing => None,
            End::Riccati => Some(regulator(axis)?.cost().clone()),
        },
    };
    StateSpaceMpcDesign::with_weights(&axis.model()?, &weights, axis.horizon, moves)
}

/// The regulator of the axis (54), α = 1.
///
/// # Errors
/// As [`Dlqr::new`].
pub fn regulator(axis: &Axis) -> Result<Dlqr, DesignError> {
    let model = Augmented::new(&axis.model()?);
    let weights = axis.weights(&model)?;
    Dlqr::new(model.a(), model.b(), weights.q(), weights.r(), 1.0)
}

/// The regulator with its moves and inputs clipped to the limits; it knows none of the rate.
///
/// # Errors
/// As [`Dlqr::new`].
pub fn clipped_regulator(axis: &Axis) -> Result<Controller, DesignError> {
    let gain = regulator(axis)?.gain().clone();
    let (range, increment) = (axis.input, axis.increment);
    let mut input = 0.0;
    Ok(Box::new(move |sample| {
        let state = [sample.delta[0], sample.delta[1], sample.state[0] - sample.goal];
        let wanted: f64 = -gain.iter().zip(state).map(|(gain, state)| gain * state).sum::<f64>();
        let before = input;
        input = (before + wanted.clamp(-increment, increment)).clamp(range[0], range[1]);
        Move { input, iterations: 0, limited: input != before + wanted }
    }))
}

fn moved(step: &Step<1>) -> Move {
    let limited = step.iterations > 0 || step.active > 0;
    Move { input: step.input.x, iterations: step.iterations, limited }
}
