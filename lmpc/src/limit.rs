//! Limits on predicted inputs and states.

use alloc::vec::Vec;

use nalgebra::DMatrix;

/// What a limit bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Δu(k+m), the move at sample m = 0, 1, …
    Increment,
    /// u(k+m), the input at sample m = 0, 1, …
    Input,
    /// The state at sample m = 1, 2, …: x_m(k+m) itself for a [`LaguerreMpc`](crate::LaguerreMpc), its deviation from the
    /// reference trajectory for a [`StateSpaceMpc`](crate::StateSpaceMpc).
    State,
}

/// D · quantity ≤ upper at some future samples. The values of `upper` are given at run time, by
/// [`Sample::upper`](crate::Sample::upper): one per row of D, for one limit after the other.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// What is bounded.
    pub quantity: Quantity,
    /// D: one row per bound, one column per input or state.
    pub directions: DMatrix<f64>,
    /// The samples m at which it holds, in any order, with gaps if need be. The last one should be about where the moves
    /// have ended: nothing bounds the plan beyond it, and far from the goal the optimum makes use of that, up to a first
    /// move in the wrong direction.
    pub samples: Vec<usize>,
    /// Whether it gives way first when not all limits can be kept.
    pub soft: bool,
}

impl Limit {
    /// Upper and lower bounds on each of `count` inputs or states: D = \[I; −I\], so that `upper` is
    /// \[largest…; −smallest…\].
    pub fn range(quantity: Quantity, count: usize, samples: impl IntoIterator<Item = usize>) -> Self {
        let mut directions = DMatrix::zeros(2 * count, count);
        for i in 0..count {
            directions[(i, i)] = 1.0;
            directions[(count + i, i)] = -1.0;
        }
        Self { quantity, directions, samples: samples.into_iter().collect(), soft: false }
    }

    /// A joint bound on two inputs: the regular polygon of `sides` sides. With `upper` =
    /// r cos(π/`sides`) it lies inside the circle of radius r and touches it with its corners.
    pub fn polygon(quantity: Quantity, sides: usize, samples: impl IntoIterator<Item = usize>) -> Self {
        let angle = |side: usize| core::f64::consts::TAU * side as f64 / sides as f64;
        let directions = DMatrix::from_fn(sides, 2, |side, axis| {
            if axis == 0 { libm::cos(angle(side)) } else { libm::sin(angle(side)) }
        });
        Self { quantity, directions, samples: samples.into_iter().collect(), soft: false }
    }

    /// The same limit, to give way first.
    pub fn soft(self) -> Self {
        Self { soft: true, ..self }
    }
}
