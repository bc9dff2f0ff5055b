//! The way to a goal that the tilt turns too slowly for.

use nalgebra::{Vector2, Vector3};
use serde::{Deserialize, Serialize};

use crate::control::cascade::most_horizontal;
use crate::control::command_limits::position_bandwidth_rad_s;
use crate::control::observation::Observation;
use crate::design::attitude_loop::AttitudeLoop;
use crate::design::braking_way::swing_s;
use crate::design::position_limits::{in_sight, planned_horizon_m};
use crate::guidance::eased_limits::EasedLimits;
use crate::guidance::reference_guidance::Guidance;
use crate::{Configuration, GRAVITY_M_S2, Limits, PositionReference, commanded_tilt_rad};

/// How long the tilt may take from one lean to the opposite one, s, for goals to be followed themselves. Plans turn the tilt within its
/// limits for a second, and take it for free to turn after that; default limits take less.
const LONGEST_SWING_S: f64 = 1.5;
/// How many times more than the limits of the tilt allow, the linear loop of the position may ask for to close an error that is planned
/// with as it is. Under limits that take twice as long to swing, goals of 10 m were missed for ever with 60 times as much.
const MOST_ASKED: f64 = 25.0;
/// Shares of the lean, and of the rate of the tilt, that the way uses: the rest is for the feedback.
const LEAN_SHARE: f64 = 0.8;
const RATE_SHARE: f64 = 0.8;
/// The least share of the lean that is left for the way by what is leant against, however much that is.
const LEAST_SHARE: f64 = 0.1;
/// A way so near to its end, m, is at its end, and so slow, m/s.
const NEAR_M: f64 = 0.01;
const NEAR_M_S: f64 = 0.01;

/// A way from where the vehicle is to a goal at rest, within the lean and the limits on rate and acceleration of the tilt. Only the
/// horizontal motion takes it.
///
/// A position error e is closed by the linear loop of bandwidth ω with a jerk of ω³e and a snap of ω⁴e. Plans keep limits of that size as
/// long as they look ahead, about the time that the default limits take to turn from one lean to the opposite one. Under limits that take
/// several times as long, a far goal is reached by turning in time, long before the end of what is foreseen.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct TurnedWay {
    /// `None` while goals are followed themselves.
    way: Option<ForetoldWay>,
}

impl TurnedWay {
    /// Goes on to a goal at a time, µs, over a closed attitude loop. What is followed then, unless it is the goal itself.
    pub(crate) fn follow(
        &mut self,
        configuration: &Configuration,
        attitude: Option<&AttitudeLoop>,
        (goal, seen): (&PositionReference, &Observation),
        time_us: u64,
    ) -> Option<PositionReference> {
        if !goal.is_at_rest() {
            self.way = None;
            return None;
        }
        let can_turn = |from: &PositionReference| {
            let error_m = seen.body.position_m.xy() - from.position_m.xy();
            asked(configuration, attitude, &error_m) <= MOST_ASKED
        };
        if self.way.is_none() && can_turn(goal) {
            return None;
        }
        let kept = self.way.filter(|way| can_turn(&way.at(goal, time_us)));
        let mut way = kept.unwrap_or_else(|| ForetoldWay::from(configuration, seen, time_us));
        let limits = turned_limits(configuration, way.lean_share);
        way.guidance.sample(&at_no_height(goal), None, (&limits, &configuration.response_times()), time_us);
        let followed = way.at(goal, time_us);
        let away_m = (followed.position_m - goal.position_m).norm();
        let ends = away_m < NEAR_M && followed.velocity_m_s.norm() < NEAR_M_S;
        // Nothing is shaped without the shaper.
        self.way = (way.guidance.is_shaped() && !ends).then_some(way);
        self.way.map(|_| followed)
    }

    /// Goal and vehicle are elsewhere, m north and east.
    pub(crate) fn shift(&mut self, by_m: &Vector2<f64>) {
        let by_m = Vector3::new(by_m.x, by_m.y, 0.0);
        self.way.iter_mut().for_each(|way| way.guidance.shift(&by_m));
    }

    /// The way, if one is followed.
    pub(crate) fn foretold(&self) -> Option<ForetoldWay> {
        self.way
    }
}

/// A way to a goal at rest of which it is known when it leads where.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct ForetoldWay {
    guidance: Guidance,
    /// Share of the lean that it uses.
    lean_share: f64,
}

impl ForetoldWay {
    /// One that goes on with the horizontal motion of a vehicle.
    fn from(configuration: &Configuration, seen: &Observation, time_us: u64) -> Self {
        let motion = seen.horizontal(configuration, &Vector3::zeros());
        let drag = configuration.drag_1_s().xy().component_mul(&motion.velocity_m_s);
        let acceleration = motion.acceleration_m_s2 + motion.disturbance_m_s2 - drag;
        let level = |vector: &Vector2<f64>| Vector3::new(vector.x, vector.y, 0.0);
        let now = PositionReference {
            velocity_m_s: level(&motion.velocity_m_s),
            acceleration_m_s2: level(&acceleration),
            ..PositionReference::goal([motion.position_m.x, motion.position_m.y, 0.0], 0.0)
        };
        let most_m_s2 = most_horizontal(0.0, commanded_tilt_rad(configuration));
        let lean_share = (LEAN_SHARE - motion.disturbance_m_s2.norm() / most_m_s2).max(LEAST_SHARE);
        let limits = EasedLimits::new(&turned_limits(configuration, lean_share));
        let times = configuration.response_times();
        Self { guidance: Guidance::moving(&now, (&limits, &times), true, time_us), lean_share }
    }

    /// Its point at a time, µs, at the height and with the heading of `goal`.
    pub(crate) fn at(&self, goal: &PositionReference, time_us: u64) -> PositionReference {
        let way = self.guidance.reference(time_us);
        PositionReference {
            position_m: way.position_m + Vector3::z() * goal.position_m.z,
            velocity_m_s: way.velocity_m_s,
            acceleration_m_s2: way.acceleration_m_s2,
            jerk_m_s3: way.jerk_m_s3,
            snap_m_s4: way.snap_m_s4,
            ..*goal
        }
    }
}

/// What closing an error asks for, as a multiple of the limits of the tilt: nothing if these swing soon enough.
fn asked(configuration: &Configuration, attitude: Option<&AttitudeLoop>, error_m: &Vector2<f64>) -> f64 {
    let limits = &configuration.limits;
    if swing_s(limits) <= LONGEST_SWING_S {
        return 0.0;
    }
    let bandwidth_rad_s = position_bandwidth_rad_s(configuration, attitude);
    let most_m_s2 = most_horizontal(0.0, commanded_tilt_rad(configuration));
    let kind = configuration.controllers.kind;
    let horizon_m = planned_horizon_m(kind, limits.speed_horizontal_m_s, most_m_s2, bandwidth_rad_s);
    let planned_m = in_sight(error_m, horizon_m).norm();
    let jerk_m_s3 = planned_m * bandwidth_rad_s * bandwidth_rad_s * bandwidth_rad_s;
    let rate = jerk_m_s3 / limits.tilt_rate_rad_s;
    let acceleration = bandwidth_rad_s * jerk_m_s3 / limits.tilt_acceleration_rad_s2;
    rate.max(acceleration) / GRAVITY_M_S2
}

/// The limits of the way. Beside a jerk j, changing the acceleration by a takes a/j, and that of the tilt to begin and to end 2j/(g α): both
/// together are shortest with j = √(a g α/2).
fn turned_limits(configuration: &Configuration, lean_share: f64) -> Limits {
    let limits = &configuration.limits;
    let acceleration_m_s2 = lean_share * most_horizontal(0.0, commanded_tilt_rad(configuration));
    let turning_m_s4 = GRAVITY_M_S2 * limits.tilt_acceleration_rad_s2;
    let soonest_m_s3 = libm::sqrt(acceleration_m_s2 * turning_m_s4 / 2.0);
    Limits {
        acceleration_horizontal_m_s2: acceleration_m_s2,
        jerk_horizontal_m_s3: (RATE_SHARE * GRAVITY_M_S2 * limits.tilt_rate_rad_s).min(soonest_m_s3),
        ..*limits
    }
}

/// The same goal at no height.
fn at_no_height(goal: &PositionReference) -> PositionReference {
    PositionReference::goal([goal.position_m.x, goal.position_m.y, 0.0], 0.0)
}
