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

    /// Of two laws that make one controller: the worse outcome, and all iterations and limits.
    pub(crate) fn with(&self, other: &Self) -> Self {
        let worse = other.status.severity() > self.status.severity();
        Self {
            status: if worse { other.status } else { self.status },
            iterations: self.iterations.saturating_add(other.iterations),
            active: self.active.saturating_add(other.active),
        }
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

#[cfg(test)]
mod tests {
    use lmpc::{Status, Step};
    use nalgebra::Vector3;

    use super::ControllerActivity;

    fn step(active: usize) -> Step<3> {
        Step {
            input: Vector3::new(1.0, -2.0, 0.0),
            increment: Vector3::zeros(),
            integral: Vector3::zeros(),
            status: Status::Relaxed,
            iterations: 5,
            active,
        }
    }

    /// As many as limits were active, or axes cut off, whichever are more.
    #[test]
    fn axes_that_were_cut_off_count_as_limits() {
        let wanted = step(0).input;
        let active = |active: usize, applied: Vector3<f64>| {
            let activity = ControllerActivity::of(&step(active), &wanted, &applied);
            assert_eq!((activity.status, activity.iterations), (Status::Relaxed, 5));
            activity.active
        };
        assert_eq!(active(0, wanted), 0);
        assert_eq!(active(0, Vector3::new(0.9, -2.0, 0.0)), 1);
        assert_eq!(active(0, Vector3::new(1.1, -1.9, 0.1)), 3);
        assert_eq!(active(2, Vector3::new(0.9, -2.0, 0.0)), 2);
    }

    #[test]
    fn two_laws_are_as_bad_as_the_worse_one() {
        let of = |status, iterations, active| ControllerActivity { status, iterations, active };
        let (fine, relaxed) = (of(Status::Optimal, 2, 3), of(Status::Relaxed, 5, 7));
        assert_eq!(fine.with(&relaxed), of(Status::Relaxed, 7, 10));
        assert_eq!(relaxed.with(&fine), of(Status::Relaxed, 7, 10));
        assert_eq!(of(Status::Held, 0, 0).with(&relaxed).status, Status::Held);
        assert_eq!(relaxed.with(&of(Status::IterationLimit, 0, 0)).status, Status::IterationLimit);
    }

    /// A billionth of 1 + |u| is rounding.
    #[test]
    fn rounding_cuts_nothing_off() {
        let active = |input: f64, cut: f64| {
            let (wanted, applied) = (Vector3::repeat(input), Vector3::new(input - cut, input, input));
            ControllerActivity::of(&Step { input: wanted, ..step(0) }, &wanted, &applied).active
        };
        for input in [0.0, 1e6, -1e6] {
            let rounding = 1e-9 * (1.0 + f64::abs(input));
            for sign in [-1.0, 1.0] {
                assert_eq!(
                    (active(input, 0.5 * sign * rounding), active(input, 2.0 * sign * rounding)),
                    (0, 1)
                );
            }
        }
    }
}
