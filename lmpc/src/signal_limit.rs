//! Limits on signals that mix the predicted state and input.

use alloc::vec::Vec;

use nalgebra::DMatrix;

/// directions · (C x_m(k+m) + D u(k+m)) ≤ upper at some future samples. The values of `upper` are given at run time, by
/// [`Sample::upper`](crate::Sample::upper): one per row of `directions`, for one limit after the other.
#[derive(Clone, Debug, PartialEq)]
pub struct SignalLimit {
    /// C: the part of the signal in the state, one row per component of the signal, one column per state.
    pub state: DMatrix<f64>,
    /// D: its part in the input.
    pub input: DMatrix<f64>,
    /// One row per bound, one column per component of the signal.
    pub directions: DMatrix<f64>,
    /// The samples m = 0, 1, … at which it holds. At m = 0 the state is measured, and only the input can be chosen.
    pub samples: Vec<usize>,
    /// By how much each bound gives way per unit of the slack that all limits share, in units of the signal. The limit that
    /// gives way most readily has the largest; none is exactly hard, so that a program always has a solution.
    pub relaxation: f64,
}

impl SignalLimit {
    /// A limit of some inputs: C = 0, D = I.
    pub fn of_inputs(states: usize, inputs: usize, directions: DMatrix<f64>, samples: Vec<usize>) -> Self {
        Self {
            state: DMatrix::zeros(inputs, states),
            input: DMatrix::identity(inputs, inputs),
            directions,
            samples,
            relaxation: 0.0,
        }
    }

    /// A limit of some states, by their indices: D = 0.
    pub fn of_states(
        states: usize,
        inputs: usize,
        limited: &[usize],
        directions: DMatrix<f64>,
        samples: Vec<usize>,
    ) -> Self {
        Self {
            state: DMatrix::from_fn(
                limited.len(),
                states,
                |row, column| {
                    if limited[row] == column { 1.0 } else { 0.0 }
                },
            ),
            input: DMatrix::zeros(limited.len(), inputs),
            directions,
            samples,
            relaxation: 0.0,
        }
    }

    /// The same limit with another relaxation.
    pub fn giving_way_by(self, relaxation: f64) -> Self {
        Self { relaxation, ..self }
    }

    /// Unit vectors to the sides of a regular polygon, `sides`×2. With `upper` = r cos(π/`sides`) it lies inside the circle of
    /// radius r and touches it with its corners.
    pub fn polygon(sides: usize) -> DMatrix<f64> {
        let angle = |side: usize| core::f64::consts::TAU * side as f64 / sides as f64;
        DMatrix::from_fn(
            sides,
            2,
            |side, axis| {
                if axis == 0 { libm::cos(angle(side)) } else { libm::sin(angle(side)) }
            },
        )
    }

    /// Upper and lower bounds of each of `count` components: \[I; −I\].
    pub fn range(count: usize) -> DMatrix<f64> {
        DMatrix::from_fn(2 * count, count, |row, column| {
            if row == column {
                1.0
            } else if row == count + column {
                -1.0
            } else {
                0.0
            }
        })
    }
}
