//! What a control step yields.

use nalgebra::SVector;
use serde::{Deserialize, Serialize};

/// How a control step ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Status {
    /// The input minimises the cost within all limits.
    Optimal,
    /// No input keeps all limits: this one minimises cost and violation together.
    Relaxed,
    /// The solver ran out of iterations: the previous input is held, or with a stabilized design the plan met last is followed.
    IterationLimit,
    /// The sample or the result was not finite: the previous input is held.
    Held,
}

impl Status {
    /// How bad it is, as records and plots have it: 0 optimal, 1 relaxed, 2 out of iterations, 3 held.
    #[must_use]
    pub const fn severity(self) -> u8 {
        match self {
            Self::Optimal => 0,
            Self::Relaxed => 1,
            Self::IterationLimit => 2,
            Self::Held => 3,
        }
    }
}

/// The outcome of one control step with P inputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<const P: usize, T = f64> {
    /// u(k), the input to apply. Report what was applied instead, if it differs, with
    /// [`ControllerState::apply`](crate::ControllerState::apply).
    pub input: SVector<T, P>,
    /// Δu(k) = u(k) − u(k−1), feed-forward included.
    pub increment: SVector<T, P>,
    /// −K_y (y − r), the share of the integral action in Δu; zero from a step that a program solved.
    pub integral: SVector<T, P>,
    /// How the input was found.
    pub status: Status,
    /// Iterations of the solver; 0 when the unconstrained optimum or the last active set was right.
    pub iterations: u32,
    /// How many limits hold with equality.
    pub active: usize,
}
