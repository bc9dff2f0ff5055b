//! The way down, for every machine that lands.

use nalgebra::{UnitQuaternion, Vector3};

use super::landing_pilot;
use super::motion::approach;
use super::proposal::Proposal;
use super::set_point::{AttitudeSetPoint, AxisTarget, PositionSetPoint, YawTarget};
use super::situation::Situation;
use super::steering::SteeringKind;

/// By how much it sinks faster per metre above the height from which it is slow, 1/s, as far as a share of the vertical acceleration and
/// jerk can brake it.
const SLOWING_PER_S: f64 = 0.4;
const BRAKING_SHARE: f64 = 0.5;
/// By how much the reference may be faster while it brakes, m/s: a reference that follows a speed with deceleration a and jerk j
/// is a²/(2 j) behind.
const LATE_M_S: f64 = 0.3;

/// Share of the weight per error of the sink rate, s/m.
const SINK_GAIN: f64 = 0.5;

/// One tick of a descent, above a target that is seen, a place (north and east, m), or wherever the vehicle comes to rest.
pub fn descend(situation: &Situation, proposal: &mut Proposal, above: Option<[f64; 2]>) {
    if situation.landed {
        match proposal.steering().kind() {
            // The blind one ends here, too.
            SteeringKind::Attitude => return proposal.idle(situation),
            SteeringKind::Idle => return,
            // It had only just begun to lift off.
            SteeringKind::Position | SteeringKind::Descent => {}
        }
    }
    if !situation.knows_its_place() {
        descend_blind(situation, proposal);
        return;
    }
    let above = situation.landing_target_m.or(above).filter(|_| !situation.landing_is_moved);
    let reference_m = &situation.outputs.setpoint.position_m;
    let height_m = situation.terrain.z_below_m(reference_m) - reference_m.z;
    let slow = situation.conduct.land_speed_m_s;
    // Slower towards the ground, within what the shaper is allowed.
    let limits = situation.braking_limits();
    let asked = situation.conduct.land_fast_m_s;
    let fastest =
        if asked > 0.0 { limits.speed_down_m_s.min(asked) } else { limits.speed_down_m_s }.max(slow);
    let jerk_m_s3 = limits.jerk_vertical_m_s3;
    let braking_m_s2 =
        (BRAKING_SHARE * limits.acceleration_vertical_m_s2).min(libm::sqrt(2.0 * jerk_m_s3 * LATE_M_S));
    let slowing_per_s = SLOWING_PER_S.min(libm::sqrt(BRAKING_SHARE * jerk_m_s3 / fastest));
    let speed = (slow
        + approach(height_m - situation.conduct.land_slow_below_m, slowing_per_s, braking_m_s2))
    .clamp(slow, fastest);
    let speed = speed.min(near_ground_m_s(situation, height_m, fastest));
    let speed = if waits_above(situation) && !situation.landing_is_moved { 0.0 } else { speed };
    let [x, y] = match (landing_pilot::velocity_m_s(situation), above) {
        (Some(velocity), _) => velocity.map(AxisTarget::Velocity),
        (None, Some(place)) => place.map(AxisTarget::Position),
        (None, None) => [AxisTarget::HOLD; 2],
    };
    let axes = [x, y, AxisTarget::Velocity(speed)];
    proposal.follow(situation, &PositionSetPoint { axes, yaw: YawTarget::Hold });
}

/// How fast PX4 sinks at most at a height, m, on a way down with `fastest_m_s`: slower from a height on, and slowest where a rangefinder
/// shows the ground.
fn near_ground_m_s(situation: &Situation, height_m: f64, fastest_m_s: f64) -> f64 {
    if situation.identity.is_ardupilot() {
        return fastest_m_s;
    }
    let (conduct, speeds) = (situation.conduct, &situation.conduct.speeds);
    let seen_m = situation.surface.map(|surface| surface.z_m - situation.outputs.position_m.z);
    if seen_m.is_some_and(|seen_m| seen_m <= speeds.crawl_below_m) {
        return speeds.crawl_m_s;
    }
    let (low_m, slow_m_s) = (conduct.land_slow_below_m, conduct.land_speed_m_s);
    let way_m = speeds.slow_below_m - low_m;
    let share = if way_m > 0.0 { ((height_m - low_m) / way_m).clamp(0.0, 1.0) } else { 1.0 };
    slow_m_s + share * (fastest_m_s - slow_m_s)
}

/// Whether it is too far beside its target to sink.
fn waits_above(situation: &Situation) -> bool {
    let farthest_m = situation.conduct.precision.farthest_m;
    let here_m = situation.outputs.position_m.xy();
    let beside_m = situation.landing_target_m.map_or(0.0, |[x, y]| libm::hypot(x - here_m.x, y - here_m.y));
    farthest_m > 0.0 && beside_m > farthest_m
}

/// A descent without an estimate of the place: level, the thrust by the sink rate. It drifts with the wind.
fn descend_blind(situation: &Situation, proposal: &mut Proposal) {
    let airframe = situation.configuration.airframe;
    let (_, strongest_n) = airframe.thrust_range_n();
    let missing_m_s = situation.sink_rate_m_s() - situation.conduct.land_speed_m_s;
    let thrust_n = airframe.weight_n() * (1.0 + SINK_GAIN * missing_m_s).clamp(0.6, 1.4);
    let level = UnitQuaternion::from_euler_angles(0.0, 0.0, situation.outputs.attitude_rad.z);
    let set_point = AttitudeSetPoint {
        attitude: Some(level),
        body_rate_rad_s: Vector3::zeros(),
        thrust: (thrust_n / strongest_n).clamp(0.0, 1.0),
    };
    proposal.follow_attitude(situation, &set_point);
}
