//! The jerk-limited reference shaper.
//!
//! The profiles are time-optimal for third-order limits from any state to any state. This file chooses the axes and their limits.

use nalgebra::{Rotation2, Vector2, Vector3};
use rsruckig::prelude::ControlInterface;
use serde::{Deserialize, Serialize};

use crate::guidance::heading::Heading;
use crate::guidance::heading_shaper::HeadingShaper;
use crate::guidance::motion_profile::{Motion, MotionProfile};
use crate::guidance::state_to_state::StateToState;
use crate::{Limits, PositionReference};

/// Share of a horizontal limit along the line to the goal, and across it: 0.98² + 0.198² < 1.
const STRAIGHT: [f64; 2] = [0.98, 0.198];
/// Both when the motion is not along that line: the largest square inside the circle.
const TURNING: [f64; 2] = [core::f64::consts::FRAC_1_SQRT_2; 2];

/// A goal that moves by less than this, m, is followed as it is, without a new plan: the controllers handle steps of that size,
/// and a goal that trembles does not make the profile tremble.
const SMALL_M: f64 = 0.01;

/// A plan from one state to the goal, as profiles over time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shaper {
    start_us: u64,
    /// The goal that was planned for; its heading is that of `heading`.
    goal: PositionReference,
    limits: Limits,
    /// How far the present goal is from the planned one, m.
    offset_m: Vector3<f64>,
    /// Direction of the first horizontal axis, rad from north.
    bearing_rad: f64,
    /// Along the bearing, across it to the right, down.
    axes: [MotionProfile; 3],
    /// The heading is planned by itself: one that keeps turning does not disturb the way.
    heading: HeadingShaper,
}

impl Shaper {
    /// A shaper that rests in one place since `time_us`.
    pub fn at_rest(position_m: &Vector3<f64>, yaw_rad: f64, limits: &Limits, time_us: u64) -> Self {
        let rest = |position| MotionProfile::constant(Motion::at(position));
        Self {
            start_us: time_us,
            goal: PositionReference::goal((*position_m).into(), yaw_rad),
            limits: *limits,
            offset_m: Vector3::zeros(),
            bearing_rad: 0.0,
            axes: [rest(position_m.x), rest(position_m.y), rest(position_m.z)],
            heading: HeadingShaper::moving(&Heading { yaw_rad, yaw_rate_rad_s: 0.0 }, time_us),
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
        let mut shaper = Self {
            axes: [motion(0), motion(1), motion(2)],
            heading: HeadingShaper::moving(&Heading::of(reference), time_us),
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
        let Heading { yaw_rad, yaw_rate_rad_s } = self.heading.heading(time_us);
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
            yaw_rad,
            yaw_rate_rad_s,
        }
    }

    /// Plans anew if the goal or the limits have changed, and only the heading if only that has. A problem that has no
    /// solution leaves the old plan in force.
    pub fn update(&mut self, goal: &PositionReference, limits: &Limits, time_us: u64) {
        let moved = goal.position_m - self.goal.position_m;
        let same_way = goal.velocity_m_s == self.goal.velocity_m_s && moved.norm() <= SMALL_M;
        if same_way && *limits == self.limits {
            self.offset_m = moved;
            self.heading.update(&Heading::of(goal), limits, time_us);
            return;
        }
        let now = self.reference(time_us);
        let way = (goal.position_m - now.position_m).xy();
        let bearing_rad = if way.norm() > 1e-6 { libm::atan2(way.y, way.x) } else { 0.0 };
        let mut heading = self.heading;
        let turns = heading.plan(&Heading::of(goal), limits, time_us);
        if let (Some(axes), true) = (plan_position(&now, goal, limits, bearing_rad), turns) {
            *self = Self {
                start_us: time_us,
                goal: *goal,
                limits: *limits,
                offset_m: Vector3::zeros(),
                bearing_rad,
                axes,
                heading,
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
    StateToState {
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
