//! Every preset hovers as published and flies the demo's flights within its own limits, without tuning.

use nalgebra::Vector3;
use quadrotor::{
    AirframePreset, Configuration, InputSignal, Inputs, Outputs, Simulation, StabilityReport,
    default_bandwidths,
};

use crate::common::{Extremes, GOAL_M, distance, fly, goal, overshoot, smooth_flight};

/// Bar of the demo for the steady error of each axis, m.
const STEADY_M: f64 = 1e-3;

fn of(preset: AirframePreset) -> Configuration {
    Configuration::for_airframe(&preset.airframe()).unwrap()
}

/// The same with references straight to the controllers.
fn unshaped(preset: AirframePreset) -> Configuration {
    let mut configuration = of(preset);
    configuration.reference.shaping = false;
    configuration
}

/// Slower loops and weaker rotors need longer: the demo's durations are those of the paper's airframe.
fn patience(configuration: &Configuration) -> f64 {
    let paper = Configuration::default();
    let bandwidth = |of: &Configuration| default_bandwidths(&of.airframe).unwrap().position_rad_s;
    let acceleration = |of: &Configuration| of.limits.acceleration_vertical_m_s2;
    let slower = bandwidth(&paper) / bandwidth(configuration);
    let weaker = (acceleration(&paper) / acceleration(configuration)).sqrt();
    slower.max(weaker).max(1.0)
}

/// Deceleration by drag at a speed, m/s².
fn dragged_m_s2(configuration: &Configuration, speed_m_s: f64) -> f64 {
    configuration.airframe.drag_n_s_m[0] * speed_m_s / configuration.airframe.mass_kg
}

/// Flies to the goal, and says how far beyond it the flight went, as a share. What is left in the last two seconds, the tilt and the
/// rotors must meet the demo's bars, and horizontal and vertical speed the limits.
fn flown(
    preset: AirframePreset,
    configuration: &Configuration,
    inputs: &impl InputSignal,
    duration_s: f64,
) -> f64 {
    let duration_s = duration_s * patience(configuration);
    let (mut extremes, mut beyond, mut steady_m) = (Extremes::new(), 0.0_f64, 0.0_f64);
    fly(configuration, inputs, duration_s, |outputs| {
        extremes.see(outputs);
        beyond = beyond.max(overshoot(outputs, GOAL_M));
        if outputs.time_us as f64 > (duration_s - 2.0) * 1e6 {
            steady_m = steady_m.max((outputs.position_m - Vector3::from(GOAL_M)).amax());
        }
    });
    assert!(steady_m <= STEADY_M, "{preset:?}: {steady_m} m left");
    extremes.assert_within(configuration);
    let limits = &configuration.limits;
    for (speed_m_s, limit_m_s) in [
        (extremes.horizontal_speed_m_s, limits.speed_horizontal_m_s),
        (extremes.climb_m_s, limits.speed_up_m_s),
        (extremes.sink_m_s, limits.speed_down_m_s),
    ] {
        assert!(speed_m_s <= 1.01 * limit_m_s, "{preset:?}: {extremes:?}, {limits:?}");
    }
    beyond
}

#[test]
fn each_hovers_at_its_published_rotor_speed() {
    for preset in AirframePreset::ALL {
        let configuration = of(preset);
        let published_rad_s = configuration.airframe.hover_rotor_speed_rad_s();
        let see = |outputs: &Outputs| {
            for speed in outputs.rotor_speed_rad_s {
                assert!((speed / published_rad_s - 1.0).abs() < 1e-6, "{preset:?}: {outputs:?}");
            }
        };
        let end = fly(&configuration, &goal([0.0; 3], 0.0), 5.0, see).outputs();
        assert!(end.position_m.norm() < 1e-6, "{preset:?}: {end:?}");
    }
}

/// Knocked off its place it comes back, as designed: no preset is warned about.
#[test]
fn each_is_stable_without_a_warning() {
    for preset in AirframePreset::ALL {
        let report = StabilityReport::new(&of(preset)).unwrap();
        assert!(report.warnings().is_empty(), "{preset:?}: {:?}", report.warnings());
        let mut configuration = of(preset);
        configuration.initial.attitude_rad = [0.3, -0.2, 0.5];
        configuration.initial.velocity_m_s = [1.0, -0.5, 0.3];
        let end = fly(&configuration, &goal([0.0; 3], 0.0), 25.0, |_| {}).outputs();
        assert!(end.position_m.norm() < 1e-3, "{preset:?}: {end:?}");
    }
}

/// The demo's "default": shaped to 5 m north, 5 m east, 10 m up.
#[test]
fn each_flies_the_shaped_goal() {
    for preset in AirframePreset::ALL {
        let configuration = of(preset);
        // The shaper does not know drag: its last metre is braked by it, too.
        let bar = 0.01 + 0.02 * dragged_m_s2(&configuration, 2.0);
        let beyond = flown(preset, &configuration, &goal(GOAL_M, 0.5), 12.0);
        assert!(beyond < bar, "{preset:?}: {beyond} beyond");
    }
}

/// The demo's "smooth": a trajectory with feed-forward.
#[test]
fn each_follows_the_smooth_trajectory() {
    for preset in AirframePreset::ALL {
        let configuration = unshaped(preset);
        let bandwidth = default_bandwidths(&configuration.airframe).unwrap().position_rad_s;
        let duration_s = 10.0;
        let signal = smooth_flight(GOAL_M, 0.5, duration_s);
        let (mut squares, mut count, mut yaw_error) = (Vector3::zeros(), 0.0, 0.0_f64);
        fly(&configuration, &signal, duration_s, |outputs| {
            let reference = signal.at(outputs.time_us).reference;
            let error = outputs.position_m - reference.position_m;
            squares += error.component_mul(&error);
            count += 1.0;
            yaw_error = yaw_error.max((outputs.attitude_rad.z - reference.yaw_rad).abs());
        });
        let rms_m = (squares / count).map(f64::sqrt).amax();
        // 5 mm without drag, which is not fed forward: its acceleration over ω² is the error of a loop without an integrator.
        let drag_m = dragged_m_s2(&configuration, 0.94) / (bandwidth * bandwidth);
        assert!(rms_m < 0.005 + 0.3 * drag_m, "{preset:?}: {rms_m} m, drag {drag_m}");
        assert!(yaw_error.to_degrees() < 0.5, "{preset:?}: {yaw_error}");
    }
}

/// The demo's "step": the goal as a raw step.
#[test]
fn each_flies_the_raw_step() {
    for preset in AirframePreset::ALL {
        let beyond = flown(preset, &unshaped(preset), &goal(GOAL_M, 0.5), 20.0);
        assert!(beyond < 0.04, "{preset:?}: {beyond} beyond");
    }
}

/// The same down: no preset sinks faster than it may.
#[test]
fn each_sinks_to_a_raw_goal() {
    for preset in AirframePreset::ALL {
        let configuration = unshaped(preset);
        let goal_m = [3.0, -4.0, 12.0];
        let (mut extremes, mut beyond) = (Extremes::new(), 0.0_f64);
        let end = fly(&configuration, &goal(goal_m, 0.0), 20.0 * patience(&configuration), |outputs| {
            extremes.see(outputs);
            beyond = beyond.max(overshoot(outputs, goal_m));
        });
        let away_m = distance(&end.outputs(), goal_m);
        let share = extremes.sink_m_s / configuration.limits.speed_down_m_s;
        assert!(beyond < 0.04 && away_m < STEADY_M, "{preset:?}: {beyond}, {away_m} m");
        assert!((0.9..1.01).contains(&share), "{preset:?}: {share}");
    }
}

/// The demo's "disturbed": pushed east, by the same share of the weight, with controllers that believe in 80 % of the mass.
#[test]
fn each_flies_disturbed_with_a_wrong_mass() {
    for preset in AirframePreset::ALL {
        let mut configuration = of(preset);
        configuration.controllers.mass_factor = 0.8;
        let push_n = configuration.airframe.weight_n() / Configuration::default().airframe.weight_n();
        let signal = |time_us: u64| {
            let mut inputs: Inputs = goal(GOAL_M, 0.5);
            if time_us >= 2_000_000 {
                inputs.disturbance.force_n.y = push_n;
            }
            inputs
        };
        flown(preset, &configuration, &signal, 20.0);
    }
}

/// Short shaped goals are nearly all jumps of the jerk. Kicks of the tilt that no torque can make had them overshot by up to 110 %.
#[test]
#[cfg(feature = "shaper")]
fn short_shaped_goals_are_tracked() {
    for preset in AirframePreset::ALL {
        let configuration = of(preset);
        for way_m in [0.05, 0.1, 0.2, 0.5, 1.0] {
            for direction in [[1.0, 0.0, 0.0], [0.5, 0.6, -0.6]] {
                let goal_m = direction.map(|part| part * way_m);
                let inputs = goal(goal_m, 0.0);
                let mut simulation = Simulation::new(&configuration, &inputs).unwrap();
                let (mut beyond, mut off) = (0.0_f64, 0.0_f64);
                for millisecond in (0..4_000).step_by(10) {
                    simulation.advance_to(millisecond * 1_000, &inputs).unwrap();
                    let outputs = simulation.outputs();
                    let reference = simulation.control().state().reference(outputs.time_us);
                    beyond = beyond.max(way_m * overshoot(&outputs, goal_m));
                    off = off.max((outputs.position_m - reference.position_m).norm());
                }
                assert!(beyond < 0.01 && off < 0.01, "{preset:?}, {way_m} m: {beyond} m beyond, {off} m off");
            }
        }
    }
}
