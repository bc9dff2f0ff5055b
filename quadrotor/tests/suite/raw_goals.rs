//! Raw goals, cruise and side forces under Laguerre MPC, on the plant with the rotors' lag and all limits.

use crate::common::{Extremes, distance, fly, goal, overshoot, tilt_rad, unshaped};
use nalgebra::Vector3;
use quadrotor::{AirframePreset, Configuration, ControllerKind, Limits};

/// Overshoot, and when the flight stays within 2 cm of its goal, s.
fn stepped(goal_m: [f64; 3], duration_s: f64) -> (f64, f64) {
    let configuration = unshaped();
    let (mut extremes, mut beyond, mut settled_s) = (Extremes::new(), 0.0_f64, 0.0);
    fly(&configuration, &goal(goal_m, 0.0), duration_s, |outputs| {
        extremes.see(outputs);
        beyond = beyond.max(overshoot(outputs, goal_m));
        if distance(outputs, goal_m) > 0.02 {
            settled_s = outputs.time_us as f64 * 1e-6;
        }
    });
    extremes.assert_within(&configuration);
    let limits = &configuration.limits;
    assert!(extremes.horizontal_speed_m_s < 1.01 * limits.speed_horizontal_m_s, "{goal_m:?}: {extremes:?}");
    assert!(extremes.climb_m_s < 1.01 * limits.speed_up_m_s, "{goal_m:?}: {extremes:?}");
    assert!(extremes.sink_m_s < 1.01 * limits.speed_down_m_s, "{goal_m:?}: {extremes:?}");
    (beyond, settled_s)
}

/// At most 4 % beyond, 5 m within 5.5 s and 20 m within 8 s.
#[test]
fn goals_are_reached_soon_and_without_swinging() {
    for (goal_m, soon_s) in [
        ([1.0, 0.0, 0.0], 4.0),
        ([5.0, 0.0, 0.0], 5.5),
        ([0.0, -20.0, 0.0], 8.0),
        ([0.0, 0.0, -5.0], 5.0),
        ([0.0, 0.0, 5.0], 5.5),
        ([12.0, -16.0, -10.0], 9.0),
    ] {
        let (beyond, settled_s) = stepped(goal_m, 15.0);
        assert!(beyond < 0.04 && settled_s < soon_s, "{goal_m:?}: {beyond}, {settled_s} s");
    }
}

/// The speed limit holds without a limit cycle, in calm air and against a newton.
#[test]
fn a_cruise_at_the_speed_limit_is_steady() {
    for against_n in [0.0, 1.0] {
        let mut inputs = goal([300.0, 0.0, 0.0], 0.0);
        inputs.disturbance.force_n.x = -against_n;
        let (mut speeds, mut tilts) =
            ([f64::INFINITY, f64::NEG_INFINITY], [f64::INFINITY, f64::NEG_INFINITY]);
        fly(&unshaped(), &inputs, 30.0, |outputs| {
            if outputs.time_us > 10_000_000 {
                let (speed, tilt) = (outputs.velocity_m_s.x, tilt_rad(outputs));
                speeds = [speeds[0].min(speed), speeds[1].max(speed)];
                tilts = [tilts[0].min(tilt), tilts[1].max(tilt)];
            }
        });
        assert!(speeds[0] > 7.9 && speeds[1] < 8.08, "{against_n} N: {speeds:?} m/s");
        assert!((tilts[1] - tilts[0]).to_degrees() < 2.0, "{against_n} N: {tilts:?} rad");
    }
}

/// Half of the weight from the side takes a lean of 27°.
#[test]
fn half_of_the_weight_is_held_from_the_side() {
    let configuration = unshaped();
    let mut inputs = goal([0.0; 3], 0.0);
    let half_n = 0.5 * configuration.airframe.weight_n();
    inputs.disturbance.force_n = Vector3::new(0.6, -0.8, 0.0) * half_n;
    let end = fly(&configuration, &inputs, 20.0, |_| {});
    let left_m = end.outputs().position_m.norm();
    assert!(left_m < 0.05, "{left_m} m");
}

/// A tilt that turns or begins to turn slowly: later, but without swinging. Goals of 10 m were missed for ever, by 170 m with a Crazyflie.
#[test]
fn goals_are_reached_by_slow_tilts() {
    let slower = |limits: &Limits, rate: f64, acceleration: f64| Limits {
        tilt_rate_rad_s: rate * limits.tilt_rate_rad_s,
        tilt_acceleration_rad_s2: acceleration * limits.tilt_acceleration_rad_s2,
        ..*limits
    };
    for (preset, kind, rate, acceleration) in [
        (AirframePreset::Paper, ControllerKind::Lmpc, 0.1, 0.1),
        (AirframePreset::Crazyflie, ControllerKind::Lmpc, 0.1, 0.1),
        (AirframePreset::Heavy, ControllerKind::Lmpc, 1.0, 0.05),
        (AirframePreset::Paper, ControllerKind::StateSpaceMpc, 0.1, 0.1),
    ] {
        let mut configuration = Configuration::for_airframe(&preset.airframe()).unwrap();
        configuration.controllers.kind = kind;
        configuration.reference.shaping = false;
        configuration.limits = slower(&configuration.limits, rate, acceleration);
        let goal_m = [8.0, -6.0, 0.0];
        let mut beyond = 0.0_f64;
        let end = fly(&configuration, &goal(goal_m, 0.0), 12.0, |outputs| {
            beyond = beyond.max(overshoot(outputs, goal_m));
        });
        let away_m = distance(&end.outputs(), goal_m);
        assert!(beyond < 0.04 && away_m < 0.02, "{preset:?} {kind:?}: {beyond}, {away_m} m");
    }
}

/// The speed limit holds between the samples of a slow controller, too: it was broken by a third.
#[test]
fn slow_samples_keep_the_speed_limit() {
    let mut configuration = Configuration::for_airframe(&AirframePreset::Iris.airframe()).unwrap();
    configuration.reference.shaping = false;
    let controllers = &mut configuration.controllers;
    (controllers.position.sample_time_us, controllers.altitude.sample_time_us) = (200_000, 200_000);
    controllers.attitude.sample_time_us = 20_000;
    let goals_m = [[25.0, -20.0, 0.0], [-25.0, 10.0, 0.0], [20.0, 25.0, 0.0], [-20.0, -15.0, 0.0]];
    let inputs = |time_us: u64| goal(goals_m[(time_us as usize / 2_000_000).min(3)], 0.0);
    let mut extremes = Extremes::new();
    fly(&configuration, &inputs, 14.0, |outputs| extremes.see(outputs));
    let share = extremes.horizontal_speed_m_s / configuration.limits.speed_horizontal_m_s;
    assert!(share < 1.03, "{share}");
}
