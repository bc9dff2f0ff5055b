//! A plan of the way: from a state to a goal, axis by axis, and what is tracked of it.

use nalgebra::{Rotation2, Vector2, Vector3};
use rsruckig::prelude::ControlInterface;
use serde::{Deserialize, Serialize};

use crate::guidance::motion_profile::{Motion, MotionProfile};
use crate::guidance::past_motion::{PastMotion, add};
use crate::guidance::smoothing::Smoothing;
use crate::guidance::state_to_state::StateToState;
use crate::{Limits, PositionReference};

/// Share of a horizontal limit along the line to the goal, and across it: 0.98² + 0.198² < 1.
const STRAIGHT: [f64; 2] = [0.98, 0.198];
/// Least share of a limit of speed across the line where the limit itself is to be flown: the less moves across, the more is left
/// along it.
const LEAST_ACROSS: f64 = 0.01;
/// How much more than the speed across the line that share is.
const ROOM_ACROSS: f64 = 2.0;
/// Both when the motion is not along that line: the largest square inside the circle.
const TURNING: [f64; 2] = [core::f64::consts::FRAC_1_SQRT_2; 2];

/// By how much more than another plan one may leave the way between its start and its goal, m: what rounding takes, and less
/// than what the controllers make of it.
const BEYOND_M: f64 = 1e-3;
/// And by how much its speed may exceed what cannot be avoided, m/s.
const FASTER_M_S: f64 = 1e-3;
/// A shorter way, m, may be flown to and fro.
const SHORT_M: f64 = 0.05;

/// A velocity below this, m/s, and an acceleration, m/s², are what rounding leaves of rest.
const RESTS: f64 = 1e-6;

/// Jerk-limited profiles over time along a bearing, across it to the right, and down. What is tracked is smoothed: see [`Smoothing`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct WayPlan {
    /// From the horizontal axes to north and east.
    turn: Rotation2<f64>,
    axes: [MotionProfile; 3],
    smoothing: Smoothing,
    /// What led to the plan, if that is smoothed over at its beginning.
    past: Option<PastMotion>,
}

/// Position and derivatives along an axis. Pairs of them lie as vectors do, so that what is stored together is loaded together: else a
/// load has to wait.
#[repr(align(16))]
struct Parts([f64; 5]);

/// What a plan does that lower limits may make worse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Excursion {
    /// How far it leaves the way between its start and its goal along each axis, m.
    beyond_m: [f64; 3],
    /// The largest speed away from its goal along each axis, m/s.
    back_m_s: [f64; 3],
}

impl Excursion {
    /// Also as fast away from the goal as another plan.
    pub fn or_back_as(self, other: &Self) -> Self {
        let back_m_s = core::array::from_fn(|axis| self.back_m_s[axis].max(other.back_m_s[axis]));
        Self { back_m_s, ..self }
    }
}

impl WayPlan {
    /// A motion that goes on with its acceleration, north, east and down.
    pub fn going_on(reference: &PositionReference, smoothing: Smoothing) -> Self {
        let reference = &smoothing.leading(reference);
        let motion = |axis: usize| {
            MotionProfile::constant(Motion {
                position: reference.position_m[axis],
                velocity: reference.velocity_m_s[axis],
                acceleration: reference.acceleration_m_s2[axis],
                jerk: 0.0,
            })
        };
        let axes = [motion(0), motion(1), motion(2)];
        Self { turn: Rotation2::identity(), axes, smoothing, past: None }
    }

    /// From a state to a goal, arriving on all axes at the same time; `None` if there is no solution. It is not smoothed yet.
    pub fn new(from: &PositionReference, goal: &PositionReference, limits: &Limits) -> Option<Self> {
        let way = (goal.position_m - from.position_m).xy();
        let bearing_rad = if way.norm() > 1e-6 { libm::atan2(way.y, way.x) } else { 0.0 };
        let turn = Rotation2::new(bearing_rad);
        let local = |world: &Vector3<f64>| {
            let horizontal = turn.inverse() * world.xy();
            [horizontal.x, horizontal.y, world.z]
        };
        // The axes are limited one by one, the vehicle in its horizontal plane: see STRAIGHT and TURNING.
        let across = |vector: &Vector3<f64>, limit: f64| local(vector)[1].abs() / limit;
        let straight = across(&from.velocity_m_s, limits.speed_horizontal_m_s) <= STRAIGHT[1]
            && across(&from.acceleration_m_s2, limits.acceleration_horizontal_m_s2) <= STRAIGHT[1];
        let shares = if straight { STRAIGHT } else { TURNING };
        let limit =
            |horizontal: f64, vertical: f64| [shares[0] * horizontal, shares[1] * horizontal, vertical];

        let speed_shares = if straight && limits.full_speed {
            let jerk = STRAIGHT[1] * limits.jerk_horizontal_m_s3;
            let beside =
                [&from.velocity_m_s, &from.acceleration_m_s2, &goal.velocity_m_s].map(|of| local(of)[1]);
            full_speed_shares(beside, jerk, limits.speed_horizontal_m_s)
        } else {
            shares
        };
        let max_velocity = [
            speed_shares[0] * limits.speed_horizontal_m_s,
            speed_shares[1] * limits.speed_horizontal_m_s,
            limits.speed_down_m_s,
        ];
        let mut min_velocity = max_velocity.map(|speed| -speed);
        min_velocity[2] = -limits.speed_up_m_s;
        let target_velocity = local(&goal.velocity_m_s);
        // Seen from where it begins: far from the origin the solver has as many digits as near it.
        let axes = StateToState {
            interface: ControlInterface::Position,
            from: core::array::from_fn(|axis| Motion {
                position: 0.0,
                velocity: local(&from.velocity_m_s)[axis],
                acceleration: local(&from.acceleration_m_s2)[axis],
                jerk: 0.0,
            }),
            target_position: local(&(goal.position_m - from.position_m)),
            target_velocity: core::array::from_fn(|axis| {
                target_velocity[axis].clamp(min_velocity[axis], max_velocity[axis])
            }),
            max_velocity,
            min_velocity,
            max_acceleration: limit(limits.acceleration_horizontal_m_s2, limits.acceleration_vertical_m_s2),
            max_jerk: limit(limits.jerk_horizontal_m_s3, limits.jerk_vertical_m_s3),
        }
        .solve()?;
        let start = local(&from.position_m);
        let axes = core::array::from_fn(|axis| axes[axis].moved(start[axis]));
        Some(Self { turn, axes, smoothing: Smoothing::default(), past: None })
    }

    /// This plan, which begins `elapsed_s` after the beginning of another one, as many metres away from it, and is smoothed together
    /// with it. A vehicle that rests is smoothed as is wanted, another one as it was: else it would jump.
    pub fn following(
        mut self,
        before: &Self,
        elapsed_s: f64,
        offset_m: &Vector3<f64>,
        wanted: Smoothing,
    ) -> Self {
        self.smoothing = if before.rests_at(elapsed_s) { wanted } else { before.smoothing };
        let reach_s = self.smoothing.reach_s();
        let begin_s = elapsed_s - reach_s;
        let mut past = match &before.past {
            Some(past) if begin_s < 0.0 => past.seen(elapsed_s, offset_m, -reach_s),
            _ => {
                let mut begin = before.unsmoothed(begin_s.max(0.0));
                begin.position_m += offset_m;
                PastMotion::new(begin_s.max(0.0) - elapsed_s, &begin)
            }
        };
        for (axis, profile) in before.axes.iter().enumerate() {
            let passed = |(start_s, _): &(f64, f64)| *start_s > begin_s && *start_s <= elapsed_s;
            for (start_s, jump) in profile.jumps(0).filter(passed) {
                past.jump(start_s - elapsed_s, &before.in_world(axis, jump));
            }
        }
        past.jump(0.0, &(self.unsmoothed(0.0).jerk_m_s3 - before.unsmoothed(elapsed_s).jerk_m_s3));
        self.past = Some(past);
        self
    }

    /// The same plan elsewhere, m.
    pub fn shift(&mut self, by_m: &Vector3<f64>) {
        let horizontal = self.turn.inverse() * by_m.xy();
        let by = [horizontal.x, horizontal.y, by_m.z];
        self.axes = core::array::from_fn(|axis| self.axes[axis].moved(by[axis]));
        self.past.iter_mut().for_each(|past| past.shift(by_m));
    }

    /// Whether nothing moves, up to rounding.
    fn rests_at(&self, time_s: f64) -> bool {
        let rests = |motion: &PositionReference| {
            motion.velocity_m_s.amax() < RESTS && motion.acceleration_m_s2.amax() < RESTS
        };
        let tracked = self.at(time_s);
        rests(&tracked) && tracked.jerk_m_s3.amax() < RESTS && rests(&self.unsmoothed(time_s))
    }

    /// A vector along one of the axes.
    fn in_world(&self, axis: usize, size: f64) -> Vector3<f64> {
        if axis == 2 {
            return Vector3::z() * size;
        }
        let [x, y] = self.turn.matrix().column(axis).into_owned().into();
        Vector3::new(x, y, 0.0) * size
    }

    /// Position and its derivatives so many seconds after its beginning, as they are tracked. The heading is zero.
    pub fn at(&self, time_s: f64) -> PositionReference {
        match &self.past {
            Some(past) if time_s < self.smoothing.reach_s() => {
                let mut now = past.smoothed(&self.smoothing, time_s);
                add(&mut now, self.in_world_of(|axis| self.smoothing.of_jumps(axis, 0, time_s)));
                PositionReference { yaw_rad: 0.0, ..now }
            }
            _ => {
                let mut now = PositionReference::goal([0.0; 3], 0.0);
                add(&mut now, self.in_world_of(|axis| self.smoothing.of(axis, time_s)));
                now
            }
        }
    }

    /// The jerk-limited motion so many seconds after its beginning.
    pub fn unsmoothed(&self, time_s: f64) -> PositionReference {
        let mut now = PositionReference::goal([0.0; 3], 0.0);
        let parts = |axis: &MotionProfile| {
            let Motion { position, velocity, acceleration, jerk } = axis.at(time_s);
            [position, velocity, acceleration, jerk, 0.0]
        };
        add(&mut now, self.in_world_of(parts));
        now
    }

    /// Position and derivatives of the axes as vectors.
    fn in_world_of(&self, parts: impl Fn(&MotionProfile) -> [f64; 5]) -> [Vector3<f64>; 5] {
        let [Parts(along), Parts(across), Parts(down)] = self.axes.each_ref().map(|axis| Parts(parts(axis)));
        core::array::from_fn(|part| {
            let horizontal = self.turn * Vector2::new(along[part], across[part]);
            Vector3::new(horizontal.x, horizontal.y, down[part])
        })
    }

    /// Where it ends, NED, m.
    pub fn end_m(&self) -> Vector3<f64> {
        let [along, across, down] = self.axes.each_ref().map(|axis| axis.end().position);
        let horizontal = self.turn * Vector2::new(along, across);
        Vector3::new(horizontal.x, horizontal.y, down)
    }

    /// How far it leaves its way from `time_s` on.
    pub fn excursion(&self, time_s: f64) -> Excursion {
        let beyond = |axis: &MotionProfile| {
            axis.extremes_from(time_s).beyond(axis.at(time_s).position, axis.end().position)
        };
        let back = |axis: &MotionProfile| {
            let [low, high] = axis.extremes_from(time_s).velocity;
            let way = axis.end().position - axis.at(time_s).position;
            // On a short way there is no backwards.
            if way.abs() < SHORT_M { 0.0 } else { (if way > 0.0 { -low } else { high }).max(0.0) }
        };
        let axes = self.axes.each_ref();
        Excursion { beyond_m: axes.map(beyond), back_m_s: axes.map(back) }
    }

    /// Whether it is as good as a plan under larger limits: it leaves its way no farther, goes back no faster, and becomes no faster than `limits`
    /// allow, than it is already, or than it must become when its acceleration is taken out with the jerk of the larger limits,
    /// `kept`.
    pub fn is_as_good_as(&self, other: &Excursion, limits: &Limits, kept: &Limits) -> bool {
        let own = self.excursion(0.0);
        let stays = own.beyond_m.iter().zip(other.beyond_m).all(|(own, other)| *own <= other + BEYOND_M)
            && own.back_m_s.iter().zip(other.back_m_s).all(|(own, other)| *own <= other + FASTER_M_S);
        let speeds = [
            [limits.speed_horizontal_m_s; 2],
            [limits.speed_horizontal_m_s; 2],
            [limits.speed_up_m_s, limits.speed_down_m_s],
        ];
        let across = TURNING[1] * kept.jerk_horizontal_m_s3;
        let jerks = [across, across, kept.jerk_vertical_m_s3];
        stays && (0..3).all(|axis| keeps_speed(&self.axes[axis], speeds[axis], jerks[axis], FASTER_M_S))
    }
}

/// Shares of the limit of speed along the line to the goal and across it, so that as much as possible is along it: from what moves
/// across, its velocity and acceleration at the start and its velocity at the goal.
fn full_speed_shares([velocity, acceleration, at_goal]: [f64; 3], jerk: f64, limit_m_s: f64) -> [f64; 2] {
    // The velocity when its acceleration has been taken back.
    let settled_m_s = velocity.abs() + acceleration * acceleration / (2.0 * jerk);
    let most_m_s = settled_m_s.max(at_goal.abs());
    let share = (ROOM_ACROSS * most_m_s / limit_m_s).clamp(LEAST_ACROSS, STRAIGHT[1]);
    [libm::sqrt(1.0 - share * share), share]
}

/// Whether a profile keeps within speeds in either direction, its speed at the start, and the one that it comes to when its
/// acceleration is taken out with a jerk.
pub(crate) fn keeps_speed(
    profile: &MotionProfile,
    [backward, forward]: [f64; 2],
    jerk: f64,
    tolerance: f64,
) -> bool {
    let Motion { velocity: now, acceleration, .. } = profile.at(0.0);
    let settled = now + acceleration * acceleration.abs() / (2.0 * jerk);
    let [low, high] = profile.extremes_from(0.0).velocity;
    low >= (-backward).min(now).min(settled) - tolerance && high <= forward.max(now).max(settled) + tolerance
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::{Smoothing, WayPlan};
    use crate::design::response_times::ResponseTimes;
    use crate::{Limits, PositionReference};

    /// A generator of numbers from 0 to 1 (Marsaglia's xorshift).
    struct Numbers(u64);

    impl Numbers {
        fn next(&mut self) -> f64 {
            self.0 ^= self.0 << 13;
            self.0 ^= self.0 >> 7;
            self.0 ^= self.0 << 17;
            (self.0 >> 11) as f64 / (1_u64 << 53) as f64
        }

        /// What rounding leaves, or a step: 1e-20 to 1 with either sign.
        fn small(&mut self) -> f64 {
            let sign = if self.next() < 0.5 { -1.0 } else { 1.0 };
            sign * libm::pow(10.0, -20.0 * self.next())
        }
    }

    /// From each goal to the next, as a vehicle is sent about: a plan begins with what rounding has left of the one before, on some axes
    /// with next to no way. The solver alone finds no plan for about a thousandth of them.
    #[test]
    fn there_is_a_plan_from_every_goal_to_the_next() {
        let mut numbers = Numbers(88_172_645_463_325_252);
        for full_speed in [false, true] {
            let limits = Limits { full_speed, ..Limits::default() };
            let mut from = PositionReference::goal([3.99607734, 0.0, -5.0], 0.0);
            for number in 0..20_000 {
                let goal_m = if number % 10 == 0 {
                    [6.0041, -2.9972, -6.0]
                } else {
                    [0, 1, 2].map(|axis: usize| match numbers.next() {
                        which if which < 0.3 => from.position_m[axis] + numbers.small(),
                        _ => libm::round(200.0 * numbers.next() - 100.0) / 10.0,
                    })
                };
                let goal = PositionReference::goal(goal_m, 0.0);
                let plan = WayPlan::new(&from, &goal, &limits);
                let plan = plan.unwrap_or_else(|| panic!("{number}: from {from:?} to {goal_m:?}"));
                let begin = plan.unsmoothed(0.0);
                assert!((begin.position_m - from.position_m).amax() < 2e-6, "{number}");
                assert!((begin.velocity_m_s - from.velocity_m_s).amax() < 2e-6, "{number}");
                // A whole plan, or one that is cut off on its way.
                let until_s =
                    if numbers.next() < 0.8 { 60.0 } else { libm::floor(5000.0 * numbers.next()) / 1000.0 };
                from = plan.unsmoothed(until_s);
                if until_s == 60.0 {
                    assert!((from.position_m - goal.position_m).amax() < 2e-6, "{number}: {from:?}");
                    assert!(from.velocity_m_s.amax() < 1e-6, "{number}: {from:?}");
                }
            }
        }
    }

    /// Goals that change while it flies, often at each sample: what is tracked goes on to its jerk, and keeps the limits. So it does
    /// where it is no longer smoothed together with the plan before.
    #[test]
    fn a_plan_goes_on_from_another_one_without_a_kick() {
        let mut numbers = Numbers(0x9E37_79B9_7F4A_7C15);
        let limits = Limits::default();
        let times = ResponseTimes { torque_delay_s: 0.035, sample_time_s: 0.05 };
        let smoothing = Smoothing::new(&limits, &times);
        let mut way = WayPlan::going_on(&PositionReference::goal([0.0; 3], 0.0), Smoothing::default());
        for number in 0..3_000 {
            let elapsed_s = 0.05 * (1.0 + libm::floor(20.0 * numbers.next() * numbers.next()));
            let goal = PositionReference::goal([0, 1, 2].map(|_| 10.0 * numbers.next() - 5.0), 0.0);
            let plan = WayPlan::new(&way.unsmoothed(elapsed_s), &goal, &limits).expect("a plan");
            let next = plan.following(&way, elapsed_s, &Vector3::zeros(), smoothing);
            let joint_s = smoothing.reach_s();
            for (before, after) in
                [(way.at(elapsed_s), next.at(0.0)), (next.at(joint_s - 1e-9), next.at(joint_s + 1e-9))]
            {
                let jumps = [
                    after.position_m - before.position_m,
                    after.velocity_m_s - before.velocity_m_s,
                    after.acceleration_m_s2 - before.acceleration_m_s2,
                    after.jerk_m_s3 - before.jerk_m_s3,
                ];
                assert!(jumps.iter().all(|jump| jump.norm() < 2e-6), "{number}: {before:?} {after:?}");
                let largest = limits.acceleration_horizontal_m_s2;
                assert!(after.acceleration_m_s2.xy().norm() < 1.001 * largest, "{number}: {after:?}");
            }
            way = next;
        }
    }
}
