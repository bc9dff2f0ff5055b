//! How the controllers came to their last inputs.

use lmpc::{Status as ControllerStatus, Step};
use nalgebra::SVector;
use serde::{Deserialize, Serialize};

/// Relative difference that the actuators' own arithmetic may make.
const ROUNDING: f64 = 1e-9;

/// How one controller came to its last input.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ControllerActivity {
    /// How the input was found.
    pub status: ControllerStatus,
    /// Iterations of the solver; 0 when no limit was near, or the last active set was still right.
    pub iterations: u32,
    /// How many limits held with equality over the horizon, or cut the input off behind the controller.
    pub active: u32,
}

/// How the three controllers came to their last inputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Activity {
    /// Of the altitude controller.
    pub altitude: ControllerActivity,
    /// Of the position controller.
    pub position: ControllerActivity,
    /// Of the attitude controller.
    pub attitude: ControllerActivity,
}

impl ControllerActivity {
    /// Of a step some axes of whose input were cut off behind it.
    pub(crate) fn of<const P: usize>(
        step: &Step<P>,
        wanted: &SVector<f64, P>,
        applied: &SVector<f64, P>,
    ) -> Self {
        let mut activity = Self::from(step);
        activity.cut(wanted, applied);
        activity
    }

    /// Counts the axes whose input was cut off, unless as many limits were active already.
    pub(crate) fn cut<const P: usize>(&mut self, wanted: &SVector<f64, P>, applied: &SVector<f64, P>) {
        let differs = |axis: &usize| {
            libm::fabs(wanted[*axis] - applied[*axis]) > ROUNDING * (1.0 + libm::fabs(wanted[*axis]))
        };
        let axes = (0..P).filter(differs).count();
        self.active = self.active.max(u32::try_from(axes).unwrap_or(u32::MAX));
    }
}

impl Default for ControllerActivity {
    fn default() -> Self {
        Self { status: ControllerStatus::Optimal, iterations: 0, active: 0 }
    }
}

impl<const P: usize> From<&Step<P>> for ControllerActivity {
    fn from(step: &Step<P>) -> Self {
        let active = u32::try_from(step.active).unwrap_or(u32::MAX);
        Self { status: step.status, iterations: step.iterations, active }
    }
}
