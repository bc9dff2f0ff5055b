//! The jerk-limited reference shaper.
//!
//! The profiles are Ruckig's (Berscheid and Kröger 2021): time-optimal for third-order limits from any
//! state to any state. This file chooses the axes and limits, and keeps the result as plain data.

use nalgebra::{Rotation2, Vector2, Vector3};
use rsruckig::prelude::{
    ControlInterface, DataArrayOrVec, InputParameter, Ruckig, Synchronization, ThrowErrorHandler, Trajectory,
};
use serde::{Deserialize, Serialize};

use crate::attitude::wrapped;
use crate::guidance::motion_profile::{Motion, MotionProfile};
use crate::{Limits, PositionReference};

/// Share of a horizontal limit along the line to the goal, and across it: 0.98² + 0.198² < 1.
const STRAIGHT: [f64; 2] = [0.98, 0.198];
/// Both when the motion is not along that line: the largest square inside the circle.
const TURNING: [f64; 2] = [core::f64::consts::FRAC_1_SQRT_2; 2];

/// A goal that moves by less than this, m or rad, is followed as it is, without a new plan: the controllers
/// handle steps of that size, and a goal that trembles does not make the profile tremble.
const SMALL: f64 = 0.01;

/// A plan from one state to the goal, as profiles over time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shaper {
    start_us: u64,
    /// The heading is planned by itself: one that keeps turning does not disturb the way.
    yaw_start_us: u64,
    /// The goal that was planned for.
    goal: PositionReference,
    limits: Limits,
    /// How far the present goal is from the planned one, m and rad.
    offset_m: Vector3<f64>,
    yaw_offset_rad: f64,
    /// Direction of the first horizontal axis, rad from north.
    bearing_rad: f64,
    /// Along the bearing, across it to the right, down.
    axes: [MotionProfile; 3],
    yaw: MotionProfile,
}

impl Shaper {
    /// A shaper that rests in one place since `time_us`.
    pub fn at_rest(position_m: &Vector3<f64>, yaw_rad: f64, limits: &Limits, time_us: u64) -> Self {
        let rest = |position| MotionProfile::constant(Motion::at(position));
        Self {
            start_us: time_us,
            yaw_start_us: time_us,
            goal: PositionReference::goal((*position_m).into(), yaw_rad),
            limits: *limits,
            offset_m: Vector3::zeros(),
            yaw_offset_rad: 0.0,
            bearing_rad: 0.0,
            axes: [rest(position_m.x), rest(position_m.y), rest(position_m.z)],
            yaw: rest(yaw_rad),
        }
    }

    /// A shaper that takes over a moving reference and brings it to rest.
    pub fn moving(reference: &PositionReference, limits: &Limits, time_us: u64) -> Self {
        let at_rest = Self::at_rest(&reference.position_m, reference.yaw_rad, limits, time_us);
        let motion = |axis: usize| {
            MotionProfile::constant(Motion {
                position: reference.position_m[axis],
                velocity: reference.velocity_m_s[axis],
                acceleration: reference.acceleration_m_s2[axis],
                jerk: 0.0,
            })
        };
        let yaw = Motion { velocity: reference.yaw_rate_rad_s, ..Motion::at(reference.yaw_rad) };
        let mut shaper = Self {
            axes: [motion(0), motion(1), motion(2)],
            yaw: MotionProfile::constant(yaw),
            // None that can be asked for: the update below always plans.
            goal: PositionReference { velocity_m_s: Vector3::repeat(f64::NAN), ..at_rest.goal },
            ..at_rest
        };
        shaper.update(
            &PositionReference::goal(reference.position_m.into(), reference.yaw_rad),
            limits,
            time_us,
        );
        // Without a plan the motion would go on for ever.
        if shaper.goal.velocity_m_s.x.is_nan() { at_rest } else { shaper }
    }

    /// The shaped reference at `time_us`.
    pub fn reference(&self, time_us: u64) -> PositionReference {
        let time_s = seconds(self.start_us, time_us);
        let motions = self.axes.map(|axis| axis.at(time_s));
        let yaw = self.yaw.at(seconds(self.yaw_start_us, time_us));
        let turn = Rotation2::new(self.bearing_rad);
        let world = |part: fn(&Motion) -> f64| {
            let [along, across, down] = motions.each_ref().map(part);
            let horizontal = turn * Vector2::new(along, across);
            Vector3::new(horizontal.x, horizontal.y, down)
        };
        PositionReference {
            position_m: world(|motion| motion.position) + self.offset_m,
            velocity_m_s: world(|motion| motion.velocity),
            acceleration_m_s2: world(|motion| motion.acceleration),
            yaw_rad: yaw.position + self.yaw_offset_rad,
            yaw_rate_rad_s: yaw.velocity,
        }
    }

    /// Plans anew if the goal or the limits have changed, and only the heading if only that has. A problem that has no
    /// solution leaves the old plan in force.
    pub fn update(&mut self, goal: &PositionReference, limits: &Limits, time_us: u64) {
        let moved = goal.position_m - self.goal.position_m;
        let turned = wrapped(goal.yaw_rad - self.goal.yaw_rad);
        let same_way = goal.velocity_m_s == self.goal.velocity_m_s && moved.norm() <= SMALL;
        let same_yaw = goal.yaw_rate_rad_s == self.goal.yaw_rate_rad_s && turned.abs() <= SMALL;
        let now = self.reference(time_us);
        let yaw_now = Motion { position: now.yaw_rad, ..self.yaw.at(seconds(self.yaw_start_us, time_us)) };
        if same_way && *limits == self.limits {
            self.offset_m = moved;
            if same_yaw && goal.yaw_rate_rad_s == 0.0 {
                self.yaw_offset_rad = turned;
            } else if let Some([yaw]) = plan_yaw(&yaw_now, goal, limits) {
                self.goal.yaw_rad = goal.yaw_rad;
                self.goal.yaw_rate_rad_s = goal.yaw_rate_rad_s;
                (self.yaw, self.yaw_start_us, self.yaw_offset_rad) = (yaw, time_us, 0.0);
            }
            return;
        }
        let way = (goal.position_m - now.position_m).xy();
        let bearing_rad = if way.norm() > 1e-6 { libm::atan2(way.y, way.x) } else { 0.0 };
        let axes = plan_position(&now, goal, limits, bearing_rad);
        let yaw = plan_yaw(&yaw_now, goal, limits);
        if let (Some(axes), Some([yaw])) = (axes, yaw) {
            *self = Self {
                start_us: time_us,
                yaw_start_us: time_us,
                goal: *goal,
                limits: *limits,
                offset_m: Vector3::zeros(),
                yaw_offset_rad: 0.0,
                bearing_rad,
                axes,
                yaw,
            };
        }
    }
}

fn seconds(since_us: u64, time_us: u64) -> f64 {
    time_us.saturating_sub(since_us) as f64 / 1e6
}

/// Along the bearing, across it and down, from a state to a goal.
fn plan_position(
    from: &PositionReference,
    goal: &PositionReference,
    limits: &Limits,
    bearing_rad: f64,
) -> Option<[MotionProfile; 3]> {
    let turn = Rotation2::new(-bearing_rad);
    let local = |world: &Vector3<f64>| {
        let horizontal = turn * world.xy();
        [horizontal.x, horizontal.y, world.z]
    };
    // The axes are limited one by one, the vehicle in its horizontal plane: see STRAIGHT and TURNING.
    let across = |vector: &Vector3<f64>, limit: f64| local(vector)[1].abs() / limit;
    let straight = across(&from.velocity_m_s, limits.speed_horizontal_m_s) <= STRAIGHT[1]
        && across(&from.acceleration_m_s2, limits.acceleration_horizontal_m_s2) <= STRAIGHT[1];
    let shares = if straight { STRAIGHT } else { TURNING };
    let limit = |horizontal: f64, vertical: f64| [shares[0] * horizontal, shares[1] * horizontal, vertical];

    let max_velocity = limit(limits.speed_horizontal_m_s, limits.speed_down_m_s);
    let mut min_velocity = max_velocity.map(|speed| -speed);
    min_velocity[2] = -limits.speed_up_m_s;
    let target_velocity = local(&goal.velocity_m_s);
    Request {
        interface: ControlInterface::Position,
        from: core::array::from_fn(|axis| Motion {
            position: local(&from.position_m)[axis],
            velocity: local(&from.velocity_m_s)[axis],
            acceleration: local(&from.acceleration_m_s2)[axis],
            jerk: 0.0,
        }),
        target_position: local(&goal.position_m),
        target_velocity: core::array::from_fn(|axis| {
            target_velocity[axis].clamp(min_velocity[axis], max_velocity[axis])
        }),
        max_velocity,
        min_velocity,
        max_acceleration: limit(limits.acceleration_horizontal_m_s2, limits.acceleration_vertical_m_s2),
        max_jerk: limit(limits.jerk_horizontal_m_s3, limits.jerk_vertical_m_s3),
    }
    .solve()
}

/// The heading, the short way round. One that keeps turning is followed by its rate: to arrive at it with that rate would take a
/// run-up, away from it.
fn plan_yaw(from: &Motion, goal: &PositionReference, limits: &Limits) -> Option<[MotionProfile; 1]> {
    let rate = limits.yaw_rate_rad_s;
    let turns = goal.yaw_rate_rad_s != 0.0;
    let left = wrapped(goal.yaw_rad - from.position);
    let wanted = if turns { goal.yaw_rate_rad_s + closing_rate(left, limits) } else { 0.0 };
    Request {
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

/// A state-to-state problem for `DOF` axes that arrive together.
struct Request<const DOF: usize> {
    /// Whether they arrive at positions with velocities, or only at velocities.
    interface: ControlInterface,
    from: [Motion; DOF],
    target_position: [f64; DOF],
    target_velocity: [f64; DOF],
    max_velocity: [f64; DOF],
    min_velocity: [f64; DOF],
    max_acceleration: [f64; DOF],
    max_jerk: [f64; DOF],
}

impl<const DOF: usize> Request<DOF> {
    fn solve(&self) -> Option<[MotionProfile; DOF]> {
        let mut input = InputParameter::<DOF>::new(None);
        input.synchronization = Synchronization::Time;
        input.control_interface = self.interface;
        input.current_position = stack(self.from.map(|motion| motion.position));
        input.current_velocity = stack(self.from.map(|motion| motion.velocity));
        input.current_acceleration = stack(self.from.map(|motion| motion.acceleration));
        input.target_position = stack(self.target_position);
        input.target_velocity = stack(self.target_velocity);
        input.max_velocity = stack(self.max_velocity);
        input.min_velocity = Some(stack(self.min_velocity));
        input.max_acceleration = stack(self.max_acceleration);
        input.max_jerk = stack(self.max_jerk);

        let mut trajectory = Trajectory::<DOF>::new(None);
        // The cycle time matters only for discrete durations, which are not asked for.
        let mut ruckig = Ruckig::<DOF, ThrowErrorHandler>::new(None, 0.01);
        ruckig.calculate(&input, &mut trajectory).ok()?;
        let profiles = trajectory.profiles.first()?;
        Some(core::array::from_fn(|axis| {
            let profile = &profiles[axis];
            let (mut start_s, mut pieces) = (0.0, None);
            let brake = &profile.brake;
            let parts = (0..2).map(|i| (brake.t[i], brake.p[i], brake.v[i], brake.a[i], brake.j[i])).chain(
                (0..7).map(|i| (profile.t[i], profile.p[i], profile.v[i], profile.a[i], profile.j[i])),
            );
            for (duration_s, position, velocity, acceleration, jerk) in parts {
                if duration_s > 0.0 {
                    add(&mut pieces, start_s, Motion { position, velocity, acceleration, jerk });
                    start_s += duration_s;
                }
            }
            let [position, velocity, acceleration] = [profile.p[7], profile.v[7], profile.a[7]];
            let last = Motion { position, velocity, acceleration, jerk: 0.0 };
            add(&mut pieces, start_s, last);
            pieces.unwrap_or_else(|| MotionProfile::constant(last))
        }))
    }
}

fn add(pieces: &mut Option<MotionProfile>, start_s: f64, motion: Motion) {
    match pieces {
        Some(profile) => profile.push(start_s, motion),
        None => *pieces = Some(MotionProfile::constant(motion)),
    }
}

fn stack<const DOF: usize>(values: [f64; DOF]) -> DataArrayOrVec<f64, DOF> {
    DataArrayOrVec::Stack(values)
}
