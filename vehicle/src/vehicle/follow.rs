//! The follow mode: at a place beside a target that moves.
//!
//! The reference moves in the frame of the place where it belongs: there it goes to a point at rest, within the limits, and what the
//! place itself does is added. So it comes to the target as to any goal and then moves exactly with it.

use nalgebra::{Rotation2, Vector2, Vector3};
use quadrotor::{Limits, PositionReference};

use super::follow_place::{FollowErrors, FollowPlace};
use super::follow_settings::{FollowHeading, FollowHeight};
use super::motion::{Motion, approach, at_rest, wrapped};
use super::notice::{Refusal, Severity};
use super::proposal::Proposal;
use super::set_point::{AxisTarget, PositionSetPoint, YawTarget};
use super::situation::Situation;
use super::steering::{Steering, SteeringKind};
use super::target::{Target, TargetMotion, TargetReport, Trust};
use super::tick::{TICK_S, TICK_US};

/// Reports nearer together than this, s, tell nothing new: with PX4's conventions, and of one tick.
const NEAREST_APART_S: f64 = 0.1;
const ANEW_S: f64 = 0.01;
/// Without a report for so long, s, the target is lost.
const LOST_S: f64 = 3.0;
/// Nearer than this, m, there is no direction to the target, and slower than this, m/s, none of the flight.
const TOO_NEAR_M: f64 = 1.0;
const TRAVELS_M_S: f64 = 1.0;
/// PX4 goes to its height first: farther than this, m, from it, it does not travel.
const HEIGHT_M: f64 = 3.0;
/// Course of a target that has not gone anywhere yet, rad: PX4's.
const NORTH_RAD: f64 = 0.0;
/// Largest acceleration on the way around the target, m/s²: PX4's. A rate, 1/s, of what is left of it when it is nearly there.
const AROUND_M_S2: f64 = 2.0;
const AROUND_RATE: f64 = 1.0;
/// Share of the horizontal acceleration that the way around may take.
const AROUND_SHARE: f64 = 0.5;
/// The vehicle can always come nearer to a target at least with this speed, m/s.
const LEAST_APPROACH_M_S: f64 = 0.5;

/// What is known of the target, and how it is followed.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Follow {
    target: Option<Target>,
    /// The reference, while it moves with the target.
    way: Option<PositionReference>,
    /// Direction from the target to the vehicle, rad, while it follows (PX4).
    bearing_rad: Option<f64>,
    /// How fast that direction turns, rad/s.
    around_rad_s: f64,
    /// Where it follows (PX4).
    place: FollowPlace,
    /// Offset that was found when the mode began, m (ArduPilot without one of its own).
    found_offset_m: Option<Vector3<f64>>,
    /// Whether the pilot was told that the target is followed.
    follows: bool,
}

impl Follow {
    /// Takes a report of the target in.
    pub fn hear(&mut self, report: &TargetReport, situation: &Situation) {
        let settings = &situation.conduct.follow;
        // ArduPilot takes what it is told.
        let trust = if situation.identity.is_ardupilot() {
            Trust { position: 1.0, velocity: 1.0, nearest_apart_s: ANEW_S }
        } else {
            let position = 1.0 - settings.smoothing;
            Trust { position, velocity: position * settings.velocity_gain, nearest_apart_s: NEAREST_APART_S }
        };
        match &mut self.target {
            Some(target) => target.update(report, &trust, situation.time_us),
            None => self.target = Some(Target::new(report, situation.time_us)),
        }
    }

    /// Whether a user may choose the mode.
    ///
    /// # Errors
    /// [`Refusal::Failed`] in ArduPilot's identity unless FOLL_ENABLE is set.
    pub fn may_begin(situation: &Situation) -> Result<(), Refusal> {
        if situation.identity.is_ardupilot() && !situation.conduct.follow.enabled {
            return Err(Refusal::Failed("Follow mode rejected: set FOLL_ENABLE to 1".to_owned()));
        }
        Ok(())
    }

    /// The mode begins.
    pub fn begin(&mut self, situation: &Situation, proposal: &mut Proposal) {
        *self = Self { target: self.target, ..Self::default() };
        proposal.hold(situation);
    }

    /// One tick of the mode.
    pub fn step(&mut self, situation: &Situation, proposal: &mut Proposal) {
        if proposal.steering().kind() == SteeringKind::Idle {
            return;
        }
        let now_us = situation.time_us;
        let target = self.target.filter(|target| target.age_s(now_us) <= LOST_S);
        let reachable = |target: &Target| is_in_reach(situation, &target.at(now_us));
        let Some(target) = target.filter(reachable) else {
            self.wait(situation, proposal);
            return;
        };
        if !self.follows {
            self.follows = true;
            proposal.say(Severity::Info, "Following the target");
        }
        let ardupilot = situation.identity.is_ardupilot();
        self.place.heed(&situation.conduct.follow);
        if !ardupilot && !self.is_at_height(&target.at(now_us), situation, proposal) {
            return;
        }
        let now = self.way.filter(|_| matches!(proposal.steering(), Steering::Motion(_)));
        let now = now.unwrap_or_else(|| proposal.steering().present(situation.outputs));
        let motions = [now_us, now_us + TICK_US].map(|time_us| target.at(time_us));
        let place = if ardupilot {
            motions.map(|motion| self.offset_place(&motion, &now, situation))
        } else {
            self.places_around(&motions, &now, situation)
        };
        let next = moved_on(&now, &place, situation.limits());
        let yaw = self.heading(&target.at(now_us + TICK_US), &next, situation);
        let axes = core::array::from_fn(|axis| AxisTarget::Track {
            position_m: next.position_m[axis],
            velocity_m_s: next.velocity_m_s[axis],
            acceleration_m_s2: next.acceleration_m_s2[axis],
            jerk_m_s3: 0.0,
        });
        proposal.follow(situation, &PositionSetPoint { axes, yaw });
        self.way = Some(next);
    }

    /// Without a target it holds.
    fn wait(&mut self, situation: &Situation, proposal: &mut Proposal) {
        if self.way.take().is_some() {
            proposal.follow(situation, &PositionSetPoint::HOLD);
        }
        (self.bearing_rad, self.around_rad_s) = (None, 0.0);
        if self.follows {
            self.follows = false;
            proposal.say(Severity::Warning, "Target lost: holding");
        }
    }

    /// PX4 climbs or sinks to its height before it travels.
    fn is_at_height(
        &mut self,
        target: &TargetMotion,
        situation: &Situation,
        proposal: &mut Proposal,
    ) -> bool {
        let z_m = self.height_z_m(target, situation);
        if self.way.is_some() || (situation.outputs.position_m.z - z_m).abs() < HEIGHT_M {
            return true;
        }
        let axes = [AxisTarget::HOLD, AxisTarget::HOLD, AxisTarget::Position(z_m)];
        let yaw = self.heading(target, &situation.outputs.setpoint, situation);
        proposal.follow(situation, &PositionSetPoint { axes, yaw });
        false
    }

    /// PX4's place, now and a tick later: at a distance and an angle from where the target goes. A new angle is gone to around the
    /// target.
    fn places_around(
        &mut self,
        motions: &[TargetMotion; 2],
        now: &PositionReference,
        situation: &Situation,
    ) -> [PositionReference; 2] {
        let target = &motions[0];
        let off = (now.position_m - target.position_m).xy();
        let behind_rad = now.yaw_rad + core::f64::consts::PI;
        let here_rad = if off.norm() > TOO_NEAR_M { libm::atan2(off.y, off.x) } else { behind_rad };
        let bearing_rad = self.bearing_rad.unwrap_or(here_rad);
        let left_rad = wrapped(target.course_rad.unwrap_or(NORTH_RAD) + self.place.angle_rad - bearing_rad);
        self.heed_sticks(target, bearing_rad, left_rad, situation);
        let rate_rad_s = self.turn_around(target, left_rad, situation);
        let later_rad = wrapped(bearing_rad + rate_rad_s * TICK_S);
        self.bearing_rad = Some(later_rad);
        let FollowPlace { distance_m, climb_m_s, retreat_m_s, .. } = self.place;
        // A time, s, before what the sticks have come to.
        let place = |target: &TargetMotion, bearing_rad: f64, ago_s: f64| {
            let outward = Rotation2::new(bearing_rad) * Vector2::x();
            let off_m = outward * (distance_m - retreat_m_s * ago_s);
            let mut place = turning_with(target, &off_m.push(0.0), rate_rad_s);
            place.position_m.z = self.height_z_m(target, situation) + climb_m_s * ago_s;
            if situation.conduct.follow.height != FollowHeight::Target {
                (place.velocity_m_s.z, place.acceleration_m_s2.z) = (0.0, 0.0);
            }
            place.velocity_m_s += (outward * retreat_m_s).push(-climb_m_s);
            place
        };
        let [before, after] = motions;
        [place(before, bearing_rad, TICK_S), place(after, later_rad, 0.0)]
    }

    /// How fast the place turns around the target, rad/s: it goes with a target that turns, and towards its angle besides, as fast as
    /// it may and as the vehicle can follow.
    fn turn_around(&mut self, target: &TargetMotion, left_rad: f64, situation: &Situation) -> f64 {
        let (limits, distance_m) = (situation.limits(), self.place.distance_m);
        // Beside the velocity of the target; where both add up, the speed is kept anyway.
        let (most_m_s, target_m_s) = (limits.speed_horizontal_m_s, target.velocity_m_s.xy().norm());
        let left_m_s = libm::sqrt((most_m_s * most_m_s - target_m_s * target_m_s).max(0.0));
        let inward_m_s2 = AROUND_SHARE * limits.acceleration_horizontal_m_s2;
        let fastest_m_s = situation
            .conduct
            .follow
            .around_m_s
            .min(left_m_s.max(LEAST_APPROACH_M_S))
            .min(libm::sqrt(inward_m_s2 * distance_m));
        let (fastest_rad_s, change_rad_s2) = (fastest_m_s / distance_m, AROUND_M_S2 / distance_m);
        let wanted_rad_s = (target.turn_rate_rad_s + approach(left_rad, AROUND_RATE, change_rad_s2))
            .clamp(-fastest_rad_s, fastest_rad_s);
        let most = change_rad_s2 * TICK_S;
        self.around_rad_s += (wanted_rad_s - self.around_rad_s).clamp(-most, most);
        self.around_rad_s
    }

    /// PX4's pilot moves the place with the sticks.
    fn heed_sticks(&mut self, target: &TargetMotion, bearing_rad: f64, left_rad: f64, situation: &Situation) {
        let sticks = situation.pilot.present_sticks().unwrap_or_default();
        let here_m = situation.outputs.position_m;
        let off = (here_m - target.position_m).xy();
        let errors = FollowErrors {
            height_m: self.height_z_m(target, situation) - here_m.z,
            distance_m: off.norm() - self.place.distance_m,
            bearing_rad: wrapped(libm::atan2(off.y, off.x) - bearing_rad),
            left_rad,
        };
        self.place.adjust(&sticks.live(&situation.conduct.sticks), &errors, TICK_S);
    }

    /// PX4's height, z, m.
    fn height_z_m(&self, target: &TargetMotion, situation: &Situation) -> f64 {
        let from_z_m = match situation.conduct.follow.height {
            FollowHeight::Home => situation.home.position_m.z,
            FollowHeight::Ground => situation.terrain.z_below_m(&target.position_m),
            FollowHeight::Target => target.position_m.z,
        };
        from_z_m - self.place.height_m
    }

    /// ArduPilot's place: at an offset, from north or from the nose of the target.
    fn offset_place(
        &mut self,
        target: &TargetMotion,
        now: &PositionReference,
        situation: &Situation,
    ) -> PositionReference {
        let settings = &situation.conduct.follow;
        let turned_rad = if settings.offset_turns { target.heading_rad.unwrap_or(0.0) } else { 0.0 };
        let given_m = Vector3::new(settings.offset_x_m, settings.offset_y_m, settings.offset_z_m);
        let offset_m = if given_m == Vector3::zeros() {
            let found = now.position_m - target.position_m;
            let unturned = (Rotation2::new(-turned_rad) * found.xy()).push(found.z);
            *self.found_offset_m.get_or_insert(unturned)
        } else {
            given_m
        };
        let rate_rad_s = if settings.offset_turns { target.turn_rate_rad_s } else { 0.0 };
        let offset = (Rotation2::new(turned_rad) * offset_m.xy()).push(offset_m.z);
        turning_with(target, &offset, rate_rad_s)
    }

    /// Where the nose points.
    fn heading(&self, target: &TargetMotion, now: &PositionReference, situation: &Situation) -> YawTarget {
        let ardupilot = situation.identity.is_ardupilot();
        let wanted = if ardupilot { situation.conduct.follow.heading } else { FollowHeading::Target };
        let v = now.velocity_m_s.xy();
        let heading = match wanted {
            FollowHeading::Hold => None,
            FollowHeading::Target => {
                let (way, v) = (
                    (target.position_m - now.position_m).xy(),
                    (target.velocity_m_s - now.velocity_m_s).xy(),
                );
                let rate_rad_s = (way.x * v.y - way.y * v.x) / way.norm_squared();
                (way.norm() > TOO_NEAR_M).then(|| (libm::atan2(way.y, way.x), rate_rad_s))
            }
            FollowHeading::SameAsTarget => {
                target.heading_rad.map(|heading_rad| (wrapped(heading_rad), target.turn_rate_rad_s))
            }
            FollowHeading::Travel => (v.norm() > TRAVELS_M_S).then(|| (libm::atan2(v.y, v.x), 0.0)),
        };
        heading
            .map_or(YawTarget::Hold, |(heading_rad, rate_rad_s)| YawTarget::Follow(heading_rad, rate_rad_s))
    }
}

/// Whether ArduPilot takes the target for one to follow.
fn is_in_reach(situation: &Situation, target: &TargetMotion) -> bool {
    let farthest_m = situation.conduct.follow.farthest_m;
    let distance_m = (target.position_m - situation.outputs.position_m).norm();
    !situation.identity.is_ardupilot() || farthest_m <= 0.0 || distance_m <= farthest_m
}

/// A place at an offset from the target that turns with a rate, rad/s: v + ω × r, a + ω × (ω × r).
fn turning_with(target: &TargetMotion, offset_m: &Vector3<f64>, rate_rad_s: f64) -> PositionReference {
    let across = Vector3::new(-offset_m.y, offset_m.x, 0.0);
    let inward = Vector3::new(-offset_m.x, -offset_m.y, 0.0);
    PositionReference {
        velocity_m_s: target.velocity_m_s + across * rate_rad_s,
        acceleration_m_s2: target.acceleration_m_s2 + inward * (rate_rad_s * rate_rad_s),
        ..at_rest(target.position_m + offset_m, 0.0)
    }
}

/// A reference a tick later, on its way to a place that moves from the first to the second of two states.
fn moved_on(now: &PositionReference, place: &[PositionReference; 2], limits: &Limits) -> PositionReference {
    let [before, after] = place;
    let relative = PositionReference {
        velocity_m_s: now.velocity_m_s - before.velocity_m_s,
        acceleration_m_s2: now.acceleration_m_s2 - before.acceleration_m_s2,
        ..at_rest(now.position_m - before.position_m, now.yaw_rad)
    };
    let goal = PositionSetPoint { axes: [AxisTarget::Position(0.0); 3], yaw: YawTarget::Hold };
    let mut motion = Motion::from(relative, goal, 0);
    let left = |limit_m_s: f64, used_m_s: f64| (limit_m_s - used_m_s).max(LEAST_APPROACH_M_S);
    let climb_m_s = before.velocity_m_s.z;
    let approach = Limits {
        speed_horizontal_m_s: left(limits.speed_horizontal_m_s, before.velocity_m_s.xy().norm()),
        speed_up_m_s: left(limits.speed_up_m_s, -climb_m_s),
        speed_down_m_s: left(limits.speed_down_m_s, climb_m_s),
        ..*limits
    };
    motion.step(&approach, TICK_S);
    let relative = motion.reference(0);
    let mut next = PositionReference {
        velocity_m_s: relative.velocity_m_s + after.velocity_m_s,
        acceleration_m_s2: relative.acceleration_m_s2 + after.acceleration_m_s2,
        ..at_rest(relative.position_m + after.position_m, now.yaw_rad)
    };
    keep_speed(&mut next, now, limits);
    next
}

/// A target that is faster than the vehicle may be is followed as fast as that is.
fn keep_speed(next: &mut PositionReference, now: &PositionReference, limits: &Limits) {
    let v = next.velocity_m_s;
    let kept = v
        .xy()
        .cap_magnitude(limits.speed_horizontal_m_s)
        .push(v.z.clamp(-limits.speed_up_m_s, limits.speed_down_m_s));
    if kept != v {
        next.velocity_m_s = kept;
        next.position_m = now.position_m + (now.velocity_m_s + kept) * (TICK_S / 2.0);
    }
}
