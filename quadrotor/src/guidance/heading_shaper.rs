//! The jerk-limited heading.

use rsruckig::prelude::ControlInterface;
use serde::{Deserialize, Serialize};

use crate::Limits;
use crate::attitude::wrapped;
use crate::guidance::heading::Heading;
use crate::guidance::motion_profile::{Motion, MotionProfile};
use crate::guidance::state_to_state::StateToState;

/// A goal that moves by less than this, rad, is followed as it is, without a new plan.
const SMALL_RAD: f64 = 0.01;

/// A plan from one heading to another, within the limits of yaw rate, acceleration and jerk.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HeadingShaper {
    start_us: u64,
    /// The goal that was planned for.
    goal: Heading,
    /// How far the present goal is from the planned one, rad.
    offset_rad: f64,
    profile: MotionProfile,
}

impl HeadingShaper {
    /// A heading that keeps turning as it does, until it is updated.
    pub fn moving(heading: &Heading, time_us: u64) -> Self {
        let now = Motion { velocity: heading.yaw_rate_rad_s, ..Motion::at(heading.yaw_rad) };
        Self { start_us: time_us, goal: *heading, offset_rad: 0.0, profile: MotionProfile::constant(now) }
    }

    /// The heading at `time_us`.
    pub fn heading(&self, time_us: u64) -> Heading {
        let now = self.profile.at(seconds(self.start_us, time_us));
        Heading { yaw_rad: now.position + self.offset_rad, yaw_rate_rad_s: now.velocity }
    }

    /// Turns to another goal; the plan is kept while the goal stays. A problem that has no solution leaves the old plan in force.
    pub fn update(&mut self, goal: &Heading, limits: &Limits, time_us: u64) {
        let turned = wrapped(goal.yaw_rad - self.goal.yaw_rad);
        let same = goal.yaw_rate_rad_s == self.goal.yaw_rate_rad_s && turned.abs() <= SMALL_RAD;
        if same && goal.yaw_rate_rad_s == 0.0 {
            self.offset_rad = turned;
        } else {
            self.plan(goal, limits, time_us);
        }
    }

    /// Plans anew. Returns whether there is a plan; without one the old one stays in force.
    pub(crate) fn plan(&mut self, goal: &Heading, limits: &Limits, time_us: u64) -> bool {
        let before = self.profile.at(seconds(self.start_us, time_us));
        let now = Motion { position: before.position + self.offset_rad, ..before };
        let Some([profile]) = plan_yaw(&now, goal, limits) else { return false };
        *self = Self { start_us: time_us, goal: *goal, offset_rad: 0.0, profile };
        true
    }
}

fn seconds(since_us: u64, time_us: u64) -> f64 {
    time_us.saturating_sub(since_us) as f64 / 1e6
}

/// The heading, the short way round. One that keeps turning is followed by its rate: to arrive at it with that rate would take a
/// run-up, away from it.
fn plan_yaw(from: &Motion, goal: &Heading, limits: &Limits) -> Option<[MotionProfile; 1]> {
    let rate = limits.yaw_rate_rad_s;
    let turns = goal.yaw_rate_rad_s != 0.0;
    let left = wrapped(goal.yaw_rad - from.position);
    let wanted = if turns { goal.yaw_rate_rad_s + closing_rate(left, limits) } else { 0.0 };
    StateToState {
        interface: if turns { ControlInterface::Velocity } else { ControlInterface::Position },
        from: [*from],
        target_position: [from.position + left],
        target_velocity: [wanted.clamp(-rate, rate)],
        max_velocity: [rate],
        min_velocity: [-rate],
        max_acceleration: [limits.yaw_acceleration_rad_s2],
        max_jerk: [limits.yaw_jerk_rad_s3],
    }
    .solve()
}

/// Rate that closes a heading error, rad/s: proportional to a small one, and of a large one what is braked in time with the room
/// that the jerk needs.
fn closing_rate(left_rad: f64, limits: &Limits) -> f64 {
    const PER_S: f64 = 1.0;
    const BRAKING: f64 = 0.3;
    let braked = libm::sqrt(2.0 * BRAKING * limits.yaw_acceleration_rad_s2 * left_rad.abs());
    libm::copysign(braked.min(PER_S * left_rad.abs()), left_rad)
}
