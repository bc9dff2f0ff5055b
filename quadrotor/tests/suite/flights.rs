//! What the closed loop must achieve on the nonlinear plant, with rotor lag and limits on.

use nalgebra::Vector3;
use proptest::prelude::*;
use quadrotor::{Configuration, InputSignal, Inputs, PositionReference, Simulation};

use crate::common::{Extremes, GOAL_M, distance, fly, goal, overshoot, smooth_flight, unshaped};

#[test]
fn a_smooth_flight_is_followed_to_millimetres() {
    let configuration = unshaped();
    let signal = smooth_flight(GOAL_M, 0.5, 10.0);
    let (mut squares, mut count, mut yaw_error) = (Vector3::zeros(), 0.0, 0.0_f64);
    let simulation = fly(&configuration, &signal, 10.0, |outputs| {
        let reference = signal.at(outputs.time_us).reference;
        let error = outputs.position_m - reference.position_m;
        squares += error.component_mul(&error);
        count += 1.0;
        yaw_error = yaw_error.max((outputs.attitude_rad.z - reference.yaw_rad).abs());
    });
    let rms = (squares / count).map(f64::sqrt);
    assert!(rms.amax() < 0.005, "RMS error {rms} m");
    assert!(distance(&simulation.outputs(), GOAL_M) < 0.001);
    assert!(yaw_error.to_degrees() < 0.5, "{}°", yaw_error.to_degrees());
}

#[test]
fn a_raw_step_arrives_within_the_limits() {
    let configuration = unshaped();
    let (mut extremes, mut beyond) = (Extremes::new(), 0.0_f64);
    let simulation = fly(&configuration, &goal(GOAL_M, 0.5), 20.0, |outputs| {
        extremes.see(outputs);
        beyond = beyond.max(overshoot(outputs, GOAL_M));
    });
    assert!(distance(&simulation.outputs(), GOAL_M) < 0.001);
    assert!(beyond < 0.2, "overshoot {beyond}");
    extremes.assert_within(&configuration);
}

#[test]
fn a_shaped_step_does_not_overshoot() {
    let configuration = Configuration::default();
    let (mut extremes, mut beyond) = (Extremes::new(), 0.0_f64);
    let simulation = fly(&configuration, &goal(GOAL_M, 0.5), 20.0, |outputs| {
        extremes.see(outputs);
        beyond = beyond.max(overshoot(outputs, GOAL_M));
    });
    assert!(distance(&simulation.outputs(), GOAL_M) < 0.001);
    assert!(beyond < 0.01, "overshoot {beyond}");
    extremes.assert_within(&configuration);
}

#[test]
fn a_goal_one_kilometre_away_is_reached_within_the_limits() {
    for goal_m in [[1000.0, 0.0, 0.0], [-600.0, 800.0, -30.0], [0.0, 0.0, -1000.0]] {
        let configuration = Configuration::default();
        let (limits, weight) = (configuration.limits, configuration.airframe.weight_n());
        let mut extremes = Extremes::new();
        let simulation = fly(&configuration, &goal(goal_m, 0.0), 300.0, |outputs| extremes.see(outputs));
        let arrived = distance(&simulation.outputs(), goal_m);
        assert!(arrived < 0.02, "{goal_m:?}: {arrived} m off");
        extremes.assert_within(&configuration);
        assert!(extremes.horizontal_speed_m_s <= limits.speed_horizontal_m_s * 1.01, "{extremes:?}");
        assert!(extremes.climb_m_s <= limits.speed_up_m_s * 1.01, "{extremes:?}");
        assert!(extremes.sink_m_s <= limits.speed_down_m_s * 1.01, "{extremes:?}");
        assert!(extremes.thrust_n[0] >= limits.thrust_min * weight - 1e-6, "{extremes:?}");
        assert!(extremes.thrust_n[1] <= limits.thrust_max * weight + 1e-6, "{extremes:?}");
    }
}

#[test]
fn side_force_and_wrong_mass_leave_no_error() {
    for mass_factor in [0.8, 1.2] {
        let mut configuration = Configuration::default();
        configuration.controllers.mass_factor = mass_factor;
        let mut inputs = goal([0.0; 3], 0.0);
        inputs.disturbance.force_n = Vector3::new(0.8, -0.6, 0.0);
        let simulation = fly(&configuration, &inputs, 40.0, |_| {});
        let left = simulation.outputs().position_m.norm();
        assert!(left < 1e-6, "mass factor {mass_factor}: {left} m");
    }
}

/// A drag force is a disturbance like any other, and wind is what it is relative to.
#[test]
fn steady_wind_leaves_no_error() {
    let mut configuration = Configuration::default();
    configuration.airframe.drag_n_s_m = [0.2, 0.2, 0.3];
    let mut inputs = goal([3.0, -2.0, -4.0], 1.0);
    inputs.disturbance.wind_m_s = Vector3::new(4.0, -3.0, 1.0);
    let simulation = fly(&configuration, &inputs, 40.0, |_| {});
    assert!(distance(&simulation.outputs(), [3.0, -2.0, -4.0]) < 1e-6);
    // It leans into the wind: ẍ = 0 needs tan(tilt) = drag · wind / m g (1 + …) to first order.
    let [phi, theta] = simulation.outputs().tilt_reference_rad;
    assert!(phi.hypot(theta) > 0.1);
}

/// Importers interpolate inputs, and people track noisy goals: a goal that trembles is held as steadily as it
/// trembles.
#[test]
fn a_goal_that_trembles_is_held() {
    for (amplitude_m, bound_m) in [(1e-15, 1e-4), (1e-8, 1e-4), (1e-4, 3e-4), (2e-3, 4e-3)] {
        let signal = |time_us: u64| {
            let mut inputs = goal([1.0, -2.0, -3.0], 0.5);
            let phase = (time_us / 50_000) as f64;
            inputs.reference.position_m.x += amplitude_m * (phase * 2.399).sin();
            inputs.reference.position_m.z += amplitude_m * (phase * 4.1).cos();
            inputs.reference.yaw_rad += amplitude_m * (phase * 1.7).sin();
            inputs
        };
        let mut worst = 0.0_f64;
        fly(&Configuration::default(), &signal, 20.0, |outputs| {
            if outputs.time_us > 12_000_000 {
                worst = worst.max(distance(outputs, [1.0, -2.0, -3.0]));
            }
        });
        assert!(worst < bound_m, "{amplitude_m} m: {worst} m");
    }
}

/// Half and double the mass, other inertias and arms: the defaults of everything else still fly.
#[test]
fn other_airframes_fly_with_the_default_controllers() {
    for (mass, inertia, arm) in
        [(0.35, 0.6, 1.0), (1.4, 1.5, 1.0), (1.0, 0.7, 0.7), (0.7, 1.3, 1.4), (0.7, 2.0, 1.0)]
    {
        for shaping in [false, true] {
            let mut configuration = Configuration::default();
            configuration.reference.shaping = shaping;
            configuration.airframe.mass_kg = mass;
            configuration.airframe.arm_length_m *= arm;
            configuration.airframe.inertia_kg_m2 = configuration.airframe.inertia_kg_m2.map(|j| j * inertia);
            let mut extremes = Extremes::new();
            let simulation = fly(&configuration, &goal(GOAL_M, 0.5), 30.0, |outputs| extremes.see(outputs));
            let left = distance(&simulation.outputs(), GOAL_M);
            assert!(left < 0.001, "{mass} kg, shaping {shaping}: {left} m");
            extremes.assert_within(&configuration);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// Steps in any direction, shaped or raw, arrive with the tilt and the rotors within their limits.
    #[test]
    fn steps_in_any_direction_stay_within_the_limits(
        x in -30.0..30.0, y in -30.0..30.0, z in -20.0..20.0, yaw in -3.0..3.0, shaping in any::<bool>(),
    ) {
        let mut configuration = Configuration::default();
        configuration.reference.shaping = shaping;
        let mut extremes = Extremes::new();
        let simulation = fly(&configuration, &goal([x, y, z], yaw), 40.0, |outputs| extremes.see(outputs));
        let left = distance(&simulation.outputs(), [x, y, z]);
        prop_assert!(left < 0.01, "{left} m off");
        prop_assert!(simulation.outputs().yaw_error_rad.abs() < 1e-3);
        prop_assert!(extremes.tilt_rad <= configuration.limits.tilt_rad, "{extremes:?}");
        prop_assert!(extremes.rotor_speed_rad_s[0] >= configuration.airframe.rotor_speed_min_rad_s - 1e-9);
        prop_assert!(extremes.rotor_speed_rad_s[1] <= configuration.airframe.rotor_speed_max_rad_s + 1e-9);
    }
}

/// A circle flown from a trajectory with feed-forward, and what the outputs say of the error.
#[test]
fn circles_are_followed_and_their_error_is_told() {
    for (radius_m, period_s, tangent) in
        [(2.0, 6.0, false), (2.0, 4.8, false), (3.0, 9.0, true), (5.0, 12.0, false)]
    {
        let rate = std::f64::consts::TAU / period_s;
        let signal = move |time_us: u64| {
            let angle = rate * time_us as f64 / 1e6;
            let (sine, cosine) = angle.sin_cos();
            let mut inputs = goal([radius_m * sine, radius_m * (1.0 - cosine), -2.0], 0.0);
            let reference = &mut inputs.reference;
            reference.velocity_m_s = Vector3::new(cosine, sine, 0.0) * (radius_m * rate);
            reference.acceleration_m_s2 = Vector3::new(-sine, cosine, 0.0) * (radius_m * rate * rate);
            if tangent {
                (reference.yaw_rad, reference.yaw_rate_rad_s) = (angle, rate);
            }
            inputs
        };
        let mut configuration = unshaped();
        configuration.initial.position_m = [0.0, 0.0, -2.0];
        configuration.initial.velocity_m_s = [radius_m * rate, 0.0, 0.0];
        let (mut worst, mut untold, mut yaw) = (0.0_f64, 0.0_f64, 0.0_f64);
        fly(&configuration, &signal, 40.0, |outputs| {
            if outputs.time_us > 20_000_000 {
                let reference = signal(outputs.time_us).reference;
                let error = outputs.position_m - reference.position_m;
                worst = worst.max(error.norm());
                untold = untold.max((outputs.tracking_error_m - error).norm());
                let off = outputs.attitude_rad.z - reference.yaw_rad;
                yaw = yaw.max((off.sin()).atan2(off.cos()).abs());
            }
        });
        assert!(worst < 0.017, "radius {radius_m}, period {period_s}: {worst} m");
        assert!(untold < 0.002, "radius {radius_m}, period {period_s}: outputs are {untold} m off");
        assert!(yaw < 0.03, "radius {radius_m}, period {period_s}: heading {yaw} rad off");
    }
}

/// Two thirds and half as much again of the mass that the controllers believe in; with half of it the vehicle
/// goes on circling its place, a few decimetres wide.
#[test]
fn grossly_wrong_masses_still_hold_their_place() {
    for (mass_factor, bound_m) in [(0.5, 0.5), (0.7, 0.001), (1.5, 0.001)] {
        let mut configuration = Configuration::default();
        configuration.controllers.mass_factor = mass_factor;
        let simulation = fly(&configuration, &goal([1.0, 1.0, -5.0], 0.0), 40.0, |_| {});
        let left = distance(&simulation.outputs(), [1.0, 1.0, -5.0]);
        assert!(left < bound_m, "mass factor {mass_factor}: {left} m");
    }
}

/// A heading that keeps turning is planned by itself: the way is the same, bit for bit.
#[test]
fn a_turning_heading_does_not_disturb_the_way() {
    let configuration = Configuration::default();
    let flown = |rate_rad_s: f64| {
        let inputs = |time_us: u64| {
            let angle_rad = rate_rad_s * time_us as f64 / 1e6;
            let mut reference = PositionReference::goal([30.0, 10.0, -12.0], angle_rad);
            reference.velocity_m_s = Vector3::new(2.0, 0.0, 0.0);
            reference.yaw_rate_rad_s = rate_rad_s;
            Inputs { reference, ..Inputs::default() }
        };
        let mut simulation = Simulation::new(&configuration, &inputs(0)).expect("defaults");
        let mut way = Vec::new();
        for tenth in 1..120 {
            simulation.advance_to(tenth * 100_000, &inputs).expect("flight");
            way.push(simulation.outputs().setpoint.position_m);
        }
        (way, simulation.outputs().setpoint.yaw_rad)
    };
    let (straight, _) = flown(0.0);
    let (turning, yaw_rad) = flown(0.2);
    assert_eq!(straight, turning);
    // Chased at the limits of turning, it stays behind a little.
    assert!((yaw_rad - 0.2 * 11.9).abs() < 0.25, "{yaw_rad}");
}

/// A heading that begins to turn is followed from where it is: no run-up against it and no lag that stays.
#[test]
fn a_heading_that_turns_is_followed_forwards() {
    const RATE_RAD_S: f64 = 0.3;
    const END_S: f64 = 6.0;
    let told = |time_s: f64| {
        if time_s < END_S { (RATE_RAD_S * time_s, RATE_RAD_S) } else { (RATE_RAD_S * END_S, 0.0) }
    };
    let inputs = |time_us: u64| {
        let mut reference = PositionReference::goal([0.0, 0.0, -5.0], 0.0);
        (reference.yaw_rad, reference.yaw_rate_rad_s) = told(time_us as f64 / 1e6);
        Inputs { reference, ..Inputs::default() }
    };
    let mut simulation = Simulation::new(&Configuration::default(), &inputs(0)).expect("defaults");
    for hundredth in 1..1200 {
        simulation.advance_to(hundredth * 10_000, &inputs).expect("flight");
        let now = simulation.outputs().setpoint;
        let (angle_rad, _) = told(hundredth as f64 / 100.0);
        assert!(hundredth > 600 || now.yaw_rate_rad_s > -0.02, "{hundredth}: {} rad/s", now.yaw_rate_rad_s);
        assert!((now.yaw_rad - angle_rad).abs() < 0.3, "{hundredth}: {} rad", now.yaw_rad);
        let settled = (400..600).contains(&hundredth) || hundredth > 1000;
        assert!(!settled || (now.yaw_rad - angle_rad).abs() < 0.02, "{hundredth}: {} rad", now.yaw_rad);
    }
}

/// A straight way is flown 2 % below the limit of speed, so that the vehicle keeps it, too; or at it when it is a commanded speed.
#[test]
fn a_straight_way_is_flown_at_its_speed() {
    for (full_speed, speed_m_s) in [(false, 0.98 * 8.0), (true, 8.0)] {
        let mut configuration = Configuration::default();
        configuration.limits.full_speed = full_speed;
        let mut simulation = Simulation::new(&configuration, &goal([90.0, 120.0, -3.0], 0.0)).unwrap();
        simulation.advance_to(12_000_000, &goal([90.0, 120.0, -3.0], 0.0)).unwrap();
        let outputs = simulation.outputs();
        let [asked, flown] = [outputs.setpoint.velocity_m_s, outputs.velocity_m_s].map(|v| v.xy().norm());
        assert!((asked - speed_m_s).abs() < 1e-3 && (flown - speed_m_s).abs() < 0.02, "{asked} {flown} m/s");
    }
}
