//! The controllers that fly a step on a loop of the cascade.

use lmpc::{
    Augmented, Controller as Law, ControllerState, DesignError, Limit, LmpcDesign, SignalLimit,
    StabilizedMpc, StateSpaceMpc, StateSpaceMpcDesign, StateSpaceMpcWeights, Weighting, unknowns,
};
use nalgebra::{DVector, SVector};

use super::axis::Axis;

/// What a controller sees.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// x.
    pub state: DVector<f64>,
    /// Its increment since the last sample.
    pub increment: DVector<f64>,
    /// x without the set-point.
    pub deviation: DVector<f64>,
    /// y − r.
    pub error: DVector<f64>,
}

/// What it does.
#[derive(Clone, Debug, PartialEq)]
pub struct Move {
    /// u(k).
    pub input: DVector<f64>,
    /// Iterations of the solver.
    pub iterations: u32,
    /// Whether limits were active.
    pub limited: bool,
}

/// A controller with what it remembers.
pub type Controller = Box<dyn FnMut(&Sample) -> Move + Send>;

/// Samples that all limits are placed on; `None` for those that fly.
pub type Placing<'a> = Option<&'a [usize]>;

/// A law as a controller.
pub(super) fn flying<const N: usize, const P: usize, const E: usize>(
    axis: &Axis,
    law: impl Law<N, P, P, E> + Send + 'static,
) -> Controller {
    let upper = axis.linear.upper.clone();
    let mut state = ControllerState::<N, P, E>::at_rest();
    Box::new(move |sample| {
        let now = lmpc::Sample {
            measured: fixed(&sample.state),
            increment: fixed(&sample.increment),
            deviation: fixed(&sample.deviation),
            error: fixed(&sample.error),
            upper: &upper,
            ..lmpc::Sample::default()
        };
        let step = law.step(&mut state, &now);
        Move {
            input: DVector::from_column_slice(step.input.as_slice()),
            iterations: step.iterations,
            limited: step.iterations > 0 || step.active > 0,
        }
    })
}

fn fixed<const N: usize>(vector: &DVector<f64>) -> SVector<f64, N> {
    SVector::from_fn(|row, _| vector[row])
}

/// Calls a constructor with the sizes of a loop: states, inputs, unknowns for so many coefficients per input.
macro_rules! sized {
    ($axis:expr, $constructor:ident, $coefficients:expr, ($($argument:expr),*)) => {
        match ($axis.linear.model.states(), $axis.linear.model.inputs()) {
            (12, 2) => $constructor::<12, 2, { unknowns(2, $coefficients) }>($($argument),*),
            (6, 2) => $constructor::<6, 2, { unknowns(2, $coefficients) }>($($argument),*),
            (3, 1) => $constructor::<3, 1, { unknowns(1, $coefficients) }>($($argument),*),
            actual => Err(DesignError::Dimension { name: "a loop of the cascade", expected: (12, 2), actual }),
        }
    };
}

/// Coefficients that the smaller and the larger programs have room for, as in flight.
const FEW: usize = 8;
const MANY: usize = 10;

/// The Laguerre MPC of the cascade with N = `terms` ≤ 10 and a = `scale`.
///
/// # Errors
/// As [`lmpc::StabilizedDesign::new`] and [`StabilizedMpc::new`].
pub fn laguerre(
    axis: &Axis,
    terms: usize,
    scale: f64,
    placing: Placing<'_>,
) -> Result<Controller, DesignError> {
    fn sized<const N: usize, const P: usize, const E: usize>(
        axis: &Axis,
        terms: usize,
        scale: f64,
        limits: &[SignalLimit],
    ) -> Result<Controller, DesignError> {
        let design = axis.linear.design(terms, scale)?;
        let law = StabilizedMpc::<N, P, P, E>::new(&design, limits, axis.linear.slack_cost)?;
        Ok(flying::<N, P, E>(axis, law))
    }
    let limits: Vec<SignalLimit> = match placing {
        None => axis.linear.limits.clone(),
        Some(samples) => {
            let limits = &axis.linear.limits;
            let same = |one: &SignalLimit, other: &SignalLimit| {
                (&one.state, &one.input, &one.directions) == (&other.state, &other.input, &other.directions)
            };
            // Of the limits that one signal has at different samples, the last is enough everywhere.
            let placed = |(place, limit): (usize, &SignalLimit)| {
                let is_last = !limits[place + 1..].iter().any(|later| same(limit, later));
                SignalLimit { samples: if is_last { samples.to_vec() } else { Vec::new() }, ..limit.clone() }
            };
            limits.iter().enumerate().map(placed).collect()
        }
    };
    if terms <= FEW {
        sized!(axis, sized, FEW, (axis, terms, scale, &limits))
    } else {
        sized!(axis, sized, MANY, (axis, terms, scale, &limits))
    }
}

/// The paper's Laguerre MPC (45) over a finite horizon, without a stabilizing feedback, under the same limits.
///
/// # Errors
/// As [`LmpcDesign::new`] and [`lmpc::LaguerreMpc::new`].
pub fn finite_laguerre(
    axis: &Axis,
    terms: usize,
    scale: f64,
    weighting: Weighting,
) -> Result<Controller, DesignError> {
    fn sized<const N: usize, const P: usize, const E: usize>(
        axis: &Axis,
        design: &LmpcDesign,
        limits: &[Limit],
    ) -> Result<Controller, DesignError> {
        Ok(flying::<N, P, E>(axis, lmpc::LaguerreMpc::<N, P, P, E>::new(design, limits)?))
    }
    let linear = &axis.linear;
    let model = Augmented::new(&linear.model);
    let bases = linear.bases(terms, scale)?;
    let design = LmpcDesign::new(&model, &linear.weights, &bases, linear.prediction_horizon, weighting)?;
    sized!(axis, sized, MANY, (axis, &design, &linear.plain_limits()))
}

/// What a state-space MPC counts at the end of its horizon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// Nothing, as in (34).
    Nothing,
    /// What the regulator would still cost.
    Riccati,
}

/// State-space MPC with one unknown per move: N_c = `moves` ≤ 50.
///
/// # Errors
/// As [`StateSpaceMpcDesign::with_weights`] and [`StateSpaceMpc::new`].
pub fn state_space(axis: &Axis, moves: usize, end: End) -> Result<Controller, DesignError> {
    fn sized<const N: usize, const P: usize, const E: usize>(
        axis: &Axis,
        design: &StateSpaceMpcDesign,
    ) -> Result<Controller, DesignError> {
        Ok(flying::<N, P, E>(axis, StateSpaceMpc::<N, P, P, E>::new(design, &axis.linear.plain_limits())?))
    }
    let design = state_space_design(axis, moves, end)?;
    if moves <= 25 {
        sized!(axis, sized, 25, (axis, &design))
    } else {
        sized!(axis, sized, 50, (axis, &design))
    }
}

/// Its design.
///
/// # Errors
/// As [`StateSpaceMpcDesign::with_weights`].
pub fn state_space_design(axis: &Axis, moves: usize, end: End) -> Result<StateSpaceMpcDesign, DesignError> {
    let linear = &axis.linear;
    let terminal = match end {
        End::Nothing => None,
        End::Riccati => Some(axis.regulator()?.cost().clone()),
    };
    let weights =
        StateSpaceMpcWeights::of_augmented(&Augmented::new(&linear.model), &linear.weights, terminal)?;
    StateSpaceMpcDesign::with_weights(&linear.model, &weights, linear.prediction_horizon, moves)
}

/// The regulator with its inputs scaled back to their limits; it knows none of the states'.
///
/// # Errors
/// As [`lmpc::Dlqr::new`].
pub fn clipped_regulator(axis: &Axis) -> Result<Controller, DesignError> {
    let gain = axis.regulator()?.gain().clone();
    let (axis, states, inputs) = (axis.clone(), axis.linear.model.states(), axis.linear.model.inputs());
    let mut input = DVector::zeros(inputs);
    Ok(Box::new(move |sample| {
        let wanted = &input
            - gain.columns(0, states) * &sample.increment
            - gain.columns(states, inputs) * &sample.error;
        // The largest multiple of it that keeps the limits of the input at hand.
        let of_input = axis.bounds().filter(|(limit, ..)| limit.state.amax() == 0.0);
        let share = of_input
            .filter(|(limit, ..)| limit.samples.contains(&0))
            .map(|(limit, direction, upper)| {
                upper / (limit.directions.row(direction) * &limit.input * &wanted)[0].max(upper)
            })
            .fold(1.0, f64::min);
        input = wanted * share;
        Move { input: input.clone(), iterations: 0, limited: share < 1.0 }
    }))
}
