//! The jerk-limited reference shaper.
//!
//! The profiles are time-optimal for third-order limits from any state to any state, and smoothed as they are tracked. This file
//! decides when to plan, and under which limits.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::design::response_times::ResponseTimes;
use crate::guidance::eased_limits::EasedLimits;
use crate::guidance::heading::Heading;
use crate::guidance::heading_shaper::HeadingShaper;
use crate::guidance::smoothing::Smoothing;
use crate::guidance::way_plan::{Excursion, WayPlan};
use crate::{Limits, PositionReference};

/// A goal that moves by less than this, m, is followed as it is, without a new plan: the controllers handle steps of that size,
/// and a goal that trembles does not make the profile tremble.
const SMALL_M: f64 = 0.01;

/// Plans reach as far as this along each axis, m: beyond it the solver runs out of digits. It is more than the longest way of
/// braking within the ranges of the limits, 13 km, and a plan to a farther goal is renewed on the way.
const FARTHEST_M: f64 = 20_000.0;
/// What is left of such a plan when it is renewed, m.
const RENEWED_M: f64 = 15_000.0;

/// A plan from one state to the goal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shaper {
    start_us: u64,
    /// The goal that was planned for; its heading is that of `heading`.
    goal: PositionReference,
    /// The limits of the plan; kept ones until the motion fits those that are wanted.
    limits: EasedLimits,
    /// How far the present goal is from the planned one, m.
    offset_m: Vector3<f64>,
    plan: WayPlan,
    /// The heading is planned by itself: one that keeps turning does not disturb the way.
    heading: HeadingShaper,
}

impl Shaper {
    /// A shaper that rests in one place since `time_us`.
    pub fn at_rest(position_m: &Vector3<f64>, yaw_rad: f64, limits: &Limits, time_us: u64) -> Self {
        let rest = PositionReference::goal((*position_m).into(), yaw_rad);
        Self {
            start_us: time_us,
            goal: rest,
            limits: EasedLimits::new(limits),
            offset_m: Vector3::zeros(),
            plan: WayPlan::going_on(&rest, Smoothing::default()),
            heading: HeadingShaper::moving(&Heading::fixed(yaw_rad), limits, time_us),
        }
    }

    /// A shaper that takes over a moving reference and brings it to rest.
    pub fn moving(
        reference: &PositionReference,
        eased: &EasedLimits,
        times: &ResponseTimes,
        time_us: u64,
    ) -> Self {
        let limits = eased.wanted();
        let at_rest = Self::at_rest(&reference.position_m, reference.yaw_rad, limits, time_us);
        let mut shaper = Self {
            plan: WayPlan::going_on(reference, Smoothing::new(eased.kept(), times)),
            limits: *eased,
            heading: HeadingShaper::moving(&Heading::of(reference), eased.kept(), time_us),
            // None that can be asked for: the update below always plans.
            goal: PositionReference { velocity_m_s: Vector3::repeat(f64::NAN), ..at_rest.goal },
            ..at_rest
        };
        shaper.update(
            &PositionReference::goal(reference.position_m.into(), reference.yaw_rad),
            (limits, times),
            time_us,
        );
        // Without a plan the motion would go on for ever.
        if shaper.goal.velocity_m_s.x.is_nan() { at_rest } else { shaper }
    }

    /// The shaped reference at `time_us`.
    pub fn reference(&self, time_us: u64) -> PositionReference {
        let now = self.plan.at(self.elapsed_s(time_us));
        let way = PositionReference { position_m: now.position_m + self.offset_m, ..now };
        self.heading(time_us).on(&way)
    }

    /// The heading of the shaped reference at `time_us`.
    pub fn heading(&self, time_us: u64) -> Heading {
        self.heading.heading(time_us)
    }

    /// Plans anew if the goal or the limits have changed, and only the heading if only that has. A problem that has no
    /// solution leaves the old plan in force, and so do lower limits as long as the motion cannot keep them.
    pub fn update(
        &mut self,
        goal: &PositionReference,
        (limits, times): (&Limits, &ResponseTimes),
        time_us: u64,
    ) {
        self.heading.update(&Heading::of(goal), limits, time_us);
        let changed = of_way(self.limits.wanted()) != of_way(limits);
        self.limits.want(limits);
        let moved = goal.position_m - self.goal.position_m;
        let same_way = goal.velocity_m_s == self.goal.velocity_m_s && moved.norm() <= SMALL_M;
        if same_way && !changed && self.keeps_limits() && !self.is_to_be_renewed(time_us) {
            self.offset_m = moved;
            return;
        }
        let elapsed_s = self.elapsed_s(time_us);
        let mut now = self.plan.unsmoothed(elapsed_s);
        now.position_m += self.offset_m;
        let plan = if same_way { self.eased(&now, goal, changed, time_us) } else { self.towards(&now, goal) };
        let Some((plan, as_wanted)) = plan else { return };
        if as_wanted {
            self.limits.release();
        }
        let smoothing = Smoothing::new(self.limits.kept(), times);
        let plan = plan.following(&self.plan, elapsed_s, &self.offset_m, smoothing);
        (self.start_us, self.goal, self.offset_m, self.plan) = (time_us, *goal, Vector3::zeros(), plan);
    }

    /// Goal and plan are elsewhere, m.
    pub fn shift(&mut self, by_m: &Vector3<f64>) {
        self.goal.position_m += by_m;
        self.plan.shift(by_m);
    }

    /// Whether the plan keeps the limits that are wanted.
    pub fn keeps_limits(&self) -> bool {
        of_way(self.limits.wanted()) == of_way(self.limits.kept())
    }

    fn elapsed_s(&self, time_us: u64) -> f64 {
        time_us.saturating_sub(self.start_us) as f64 / 1e6
    }

    /// Whether a plan that ends before its goal has come near its end.
    fn is_to_be_renewed(&self, time_us: u64) -> bool {
        let end_m = self.plan.end_m();
        let left_m = (end_m - self.plan.unsmoothed(self.elapsed_s(time_us)).position_m).amax();
        left_m < RENEWED_M && (self.goal.position_m - end_m).amax() > SMALL_M
    }

    /// A plan to another goal, and whether it is within the wanted limits: as far as it does not leave its way farther than the
    /// kept ones would.
    fn towards(&self, now: &PositionReference, goal: &PositionReference) -> Option<(WayPlan, bool)> {
        let goal = within_reach(now, goal);
        if self.keeps_limits() {
            return WayPlan::new(now, &goal, self.limits.wanted()).map(|plan| (plan, true));
        }
        // As the motion would have gone on, with its speeds, too, if it stays nearer to its way so.
        let as_before = WayPlan::new(now, &goal, self.limits.kept())?;
        let bar = self.bar(as_before.excursion(0.0), now, &goal);
        let plan = self.limits.least(|limits| self.good_plan(now, &goal, limits, &bar));
        plan.or(Some((as_before, false)))
    }

    /// A plan to the same goal within other limits, and whether it is within the wanted ones. `None` if the present plan is to
    /// be flown on: the wanted limits would lead farther off the way. Between them is looked for only once.
    fn eased(
        &self,
        now: &PositionReference,
        goal: &PositionReference,
        changed: bool,
        time_us: u64,
    ) -> Option<(WayPlan, bool)> {
        let goal = within_reach(now, goal);
        if self.keeps_limits() {
            return WayPlan::new(now, &goal, self.limits.wanted()).map(|plan| (plan, true));
        }
        let bar = self.bar(self.plan.excursion(self.elapsed_s(time_us)), now, &goal);
        if !changed {
            return self.good_plan(now, &goal, self.limits.wanted(), &bar).map(|plan| (plan, true));
        }
        self.limits.least(|limits| self.good_plan(now, &goal, limits, &bar))
    }

    /// What a plan may do: no more than the motion would have done, but that braking to a lower speed may reverse it.
    fn bar(&self, before: Excursion, now: &PositionReference, goal: &PositionReference) -> Excursion {
        let braking = WayPlan::new(now, goal, &self.limits.largest());
        braking.map_or(before, |plan| before.or_back_as(&plan.excursion(0.0)))
    }

    /// A plan within limits that is as good as another one within the kept limits.
    fn good_plan(
        &self,
        now: &PositionReference,
        goal: &PositionReference,
        limits: &Limits,
        bar: &Excursion,
    ) -> Option<WayPlan> {
        WayPlan::new(now, goal, limits)
            .filter(|plan| plan.is_as_good_as(bar, self.limits.wanted(), self.limits.kept()))
    }
}

/// The limits of the way.
fn of_way(limits: &Limits) -> [f64; 7] {
    [
        limits.speed_horizontal_m_s,
        limits.speed_up_m_s,
        limits.speed_down_m_s,
        limits.acceleration_horizontal_m_s2,
        limits.acceleration_vertical_m_s2,
        limits.jerk_horizontal_m_s3,
        limits.jerk_vertical_m_s3,
    ]
}

/// The goal, or a place to rest at on the straight line to it if it is farther away than a plan reaches.
fn within_reach(now: &PositionReference, goal: &PositionReference) -> PositionReference {
    // In units in which no difference of finite numbers is infinite.
    let unit_m = goal.position_m.amax().max(now.position_m.amax()).max(1.0);
    let way = goal.position_m / unit_m - now.position_m / unit_m;
    let reach = FARTHEST_M / unit_m;
    if way.amax() <= reach {
        return *goal;
    }
    let position_m = now.position_m + way * (FARTHEST_M / way.amax());
    PositionReference { velocity_m_s: Vector3::zeros(), position_m, ..*goal }
}
