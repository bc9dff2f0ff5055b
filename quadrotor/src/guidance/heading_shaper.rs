//! The jerk-limited heading.

use rsruckig::prelude::ControlInterface;
use serde::{Deserialize, Serialize};

use crate::Limits;
use crate::attitude::wrapped;
use crate::guidance::eased_limits::EasedLimits;
use crate::guidance::heading::Heading;
use crate::guidance::motion_profile::{Motion, MotionProfile};
use crate::guidance::state_to_state::StateToState;
use crate::guidance::way_plan::keeps_speed;

/// A goal that moves by less than this, rad, is followed as it is, without a new plan.
const SMALL_RAD: f64 = 0.01;
/// By how much a turn within lower limits may go farther, rad, and faster, rad/s, than within the larger ones.
const TOLERANCE: f64 = 1e-3;

/// A plan from one heading to another, within the limits of yaw rate, acceleration and jerk.
///
/// Limits that are lowered during a turn hold as far as the turn can keep them: one that would swing past its goal goes on within
/// the larger ones.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HeadingShaper {
    start_us: u64,
    /// The goal that was planned for.
    goal: Heading,
    /// The limits of the plan; kept ones until the turn fits those that are wanted.
    limits: EasedLimits,
    /// How far the present goal is from the planned one, rad.
    offset_rad: f64,
    profile: MotionProfile,
}

impl HeadingShaper {
    /// A heading that keeps turning as it does, until it is updated.
    pub fn moving(heading: &Heading, limits: &Limits, time_us: u64) -> Self {
        let now = Motion { velocity: heading.yaw_rate_rad_s, ..Motion::at(heading.yaw_rad) };
        Self {
            start_us: time_us,
            goal: *heading,
            limits: EasedLimits::new(limits),
            offset_rad: 0.0,
            profile: MotionProfile::constant(now),
        }
    }

    /// The heading at `time_us`.
    pub fn heading(&self, time_us: u64) -> Heading {
        let now = self.profile.at(self.elapsed_s(time_us));
        Heading {
            yaw_rad: now.position + self.offset_rad,
            yaw_rate_rad_s: now.velocity,
            yaw_acceleration_rad_s2: now.acceleration,
        }
    }

    /// Turns to another goal; the plan is kept while goal and limits stay. A problem that has no solution leaves the old plan in
    /// force.
    pub fn update(&mut self, goal: &Heading, limits: &Limits, time_us: u64) {
        let changed = of_turn(self.limits.wanted()) != of_turn(limits);
        self.limits.want(limits);
        let turned = wrapped(goal.yaw_rad - self.goal.yaw_rad);
        let same = goal.yaw_rate_rad_s == 0.0 && self.goal.yaw_rate_rad_s == 0.0 && turned.abs() <= SMALL_RAD;
        if same && !changed && self.keeps_limits() {
            self.offset_rad = turned;
            return;
        }
        let before = self.profile.at(self.elapsed_s(time_us));
        let now = Motion { position: before.position + self.offset_rad, ..before };
        let Some((profile, as_wanted)) = self.planned(&now, goal, same.then_some(changed), time_us) else {
            return;
        };
        if as_wanted {
            self.limits.release();
        }
        (self.start_us, self.goal, self.offset_rad, self.profile) = (time_us, *goal, 0.0, profile);
    }

    fn keeps_limits(&self) -> bool {
        of_turn(self.limits.wanted()) == of_turn(self.limits.kept())
    }

    fn elapsed_s(&self, time_us: u64) -> f64 {
        time_us.saturating_sub(self.start_us) as f64 / 1e6
    }

    /// A plan and whether it is within the wanted limits. `same` tells that the goal is that of the present plan, and whether
    /// the limits have just changed; as long as those cannot be kept the present plan is flown on.
    fn planned(
        &self,
        now: &Motion,
        goal: &Heading,
        same: Option<bool>,
        time_us: u64,
    ) -> Option<(MotionProfile, bool)> {
        if self.keeps_limits() {
            return plan_yaw(now, goal, self.limits.wanted()).map(|profile| (profile, true));
        }
        let as_before = plan_yaw(now, goal, self.limits.kept());
        let bar = match same {
            Some(_) => beyond(&self.profile, self.elapsed_s(time_us)),
            None => excess(now, goal, &as_before?, self.limits.kept())?,
        };
        let plan = |limits: &Limits| {
            let profile = plan_yaw(now, goal, limits)?;
            let stays = excess(now, goal, &profile, limits)? <= bar + TOLERANCE;
            let rates = [self.limits.wanted().yaw_rate_rad_s; 2];
            let jerk = self.limits.kept().yaw_jerk_rad_s3;
            (stays && keeps_speed(&profile, rates, jerk, TOLERANCE)).then_some(profile)
        };
        if same == Some(false) {
            return plan(self.limits.wanted()).map(|profile| (profile, true));
        }
        let as_before = as_before.filter(|_| same.is_none()).map(|profile| (profile, false));
        self.limits.least(plan).or(as_before)
    }
}

/// The limits of a turn.
fn of_turn(limits: &Limits) -> [f64; 3] {
    [limits.yaw_rate_rad_s, limits.yaw_acceleration_rad_s2, limits.yaw_jerk_rad_s3]
}

/// How far a profile swings past its end from `time_s` on, or back, rad.
fn beyond(profile: &MotionProfile, time_s: f64) -> f64 {
    profile.extremes_from(time_s).beyond(profile.at(time_s).position, profile.end().position)
}

/// How far a plan swings past its goal, rad. One that follows a turning goal is judged by the angle that it turns relative to the
/// goal until it has the goal's rate.
fn excess(from: &Motion, goal: &Heading, profile: &MotionProfile, limits: &Limits) -> Option<f64> {
    if goal.yaw_rate_rad_s == 0.0 {
        return Some(beyond(profile, 0.0));
    }
    let followed = to_rate(from, goal.yaw_rate_rad_s, limits)?;
    let moved = goal.yaw_rate_rad_s * followed.duration_s();
    let turned = followed.end().position - from.position - moved;
    let left = wrapped(goal.yaw_rad - from.position);
    Some(if turned * left > 0.0 { (turned.abs() - left.abs()).max(0.0) } else { turned.abs() })
}

/// The fastest change to a rate, rad/s.
fn to_rate(from: &Motion, rate_rad_s: f64, limits: &Limits) -> Option<MotionProfile> {
    let most = limits.yaw_rate_rad_s;
    let [profile] = StateToState {
        interface: ControlInterface::Velocity,
        from: [*from],
        target_position: [0.0],
        target_velocity: [rate_rad_s.clamp(-most, most)],
        max_velocity: [most],
        min_velocity: [-most],
        max_acceleration: [limits.yaw_acceleration_rad_s2],
        max_jerk: [limits.yaw_jerk_rad_s3],
    }
    .solve()?;
    Some(profile)
}

/// The heading, the short way round. One that keeps turning is followed by its rate: to arrive at it with that rate would take a
/// run-up, away from it.
fn plan_yaw(from: &Motion, goal: &Heading, limits: &Limits) -> Option<MotionProfile> {
    let left = wrapped(goal.yaw_rad - from.position);
    if goal.yaw_rate_rad_s != 0.0 {
        return to_rate(from, goal.yaw_rate_rad_s + closing_rate(left, limits), limits);
    }
    let rate = limits.yaw_rate_rad_s;
    let [profile] = StateToState {
        interface: ControlInterface::Position,
        from: [*from],
        target_position: [from.position + left],
        target_velocity: [0.0],
        max_velocity: [rate],
        min_velocity: [-rate],
        max_acceleration: [limits.yaw_acceleration_rad_s2],
        max_jerk: [limits.yaw_jerk_rad_s3],
    }
    .solve()?;
    Some(profile)
}

/// Rate that closes a heading error, rad/s: proportional to a small one, and of a large one what is braked in time with the room
/// that the jerk needs.
fn closing_rate(left_rad: f64, limits: &Limits) -> f64 {
    const PER_S: f64 = 1.0;
    const BRAKING: f64 = 0.3;
    let braked = libm::sqrt(2.0 * BRAKING * limits.yaw_acceleration_rad_s2 * left_rad.abs());
    libm::copysign(braked.min(PER_S * left_rad.abs()), left_rad)
}
