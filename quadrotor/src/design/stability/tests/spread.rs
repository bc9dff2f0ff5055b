//! Noise spreads nonlinear flights as far as the report says.

extern crate std;
use std::format;
use std::vec::Vec;

use super::flight::{End, designed, fly, towards};
use crate::{Configuration, ControllerKind, PredictionModel, Sensors};

/// Standard deviations over a flight of two minutes: tilt, horizontal position, height and yaw.
fn measured(configuration: &Configuration) -> [f64; 4] {
    let design = designed(configuration).expect("a design");
    let (mut count, mut sums, mut squares) = (0.0, [0.0; 6], [0.0; 6]);
    let end = fly(design, &towards([0.0; 3], 0.0), 125.0, 10_000, |outputs| {
        if outputs.time_us > 5_000_000 {
            count += 1.0;
            let (angle, place) = (outputs.attitude_rad, outputs.position_m);
            let seen = [angle.x, angle.y, place.x, place.y, place.z, angle.z];
            for ((sum, square), seen) in sums.iter_mut().zip(&mut squares).zip(seen) {
                *sum += seen;
                *square += seen * seen;
            }
        }
    });
    assert_eq!(end, End::Flown);
    let variance = |index: usize| squares[index] / count - (sums[index] / count) * (sums[index] / count);
    let both = |one, other| libm::sqrt((variance(one) + variance(other)) / 2.0);
    [both(0, 1), both(2, 3), both(4, 4), both(5, 5)]
}

/// The same figures by the report.
fn expected(configuration: &Configuration) -> [f64; 4] {
    let report = designed(configuration).expect("a design").stability;
    let [_, _, yaw, north, _, altitude] = report.loops().map(|each| each.spread.expect("noise"));
    [north.angle_rad, north.position_m, altitude.position_m, yaw.angle_rad]
}

/// The noise is small enough for two effects that the linear loops do not have. From 1 mm of position noise on,
/// limits.tilt_acceleration cuts the DLQR's commands to the tilt, which triples the horizontal spread; and attitude noise
/// moves the height with its square (see below). Over two minutes the standard deviation of the slowest loops is known to
/// about a tenth.
#[test]
fn noise_spreads_tilt_position_height_and_heading_as_the_report_says() {
    let none = Sensors { seed: 1, ..Sensors::default() };
    let of_position = Sensors { position_noise_m: 2.5e-4, velocity_noise_m_s: 2.5e-4, ..none };
    let of_attitude = Sensors { attitude_noise_rad: 1.25e-4, body_rate_noise_rad_s: 1.25e-4, ..none };
    let mut differing = Vec::new();
    for kind in [ControllerKind::Lmpc, ControllerKind::StateSpaceMpc, ControllerKind::Dlqr] {
        for output_feedback in [false, true] {
            for sensors in [of_position, of_attitude] {
                let mut configuration = Configuration::default();
                configuration.controllers.kind = kind;
                configuration.sensors = Sensors { output_feedback, ..sensors };
                let figures = measured(&configuration).into_iter().zip(expected(&configuration));
                for (index, (measured, expected)) in figures.enumerate() {
                    let share = measured / expected;
                    if expected > 0.0 && (share - 1.0).abs() > 0.2 {
                        differing.push(format!("{kind:?} {output_feedback} {index}: {measured} {expected}"));
                    }
                }
            }
        }
    }
    assert!(differing.is_empty(), "{differing:?}");
}

/// The rotors' speeds follow their commands with a lag, and thrust is their square. While torque commands change, the rotors
/// that speed up gain less thrust than the others lose: noise of the attitude costs height, by its square. So it is with the
/// paper's models, where commands are the roots of thrusts. By default they are those after which the thrust has the lag, and
/// the height keeps still.
#[test]
fn attitude_noise_moves_the_height_only_where_thrust_is_taken_for_prompt() {
    let height = |model, attitude_noise_rad: f64| {
        let mut configuration = Configuration::default();
        configuration.controllers.model = model;
        configuration.sensors.output_feedback = true;
        configuration.sensors.attitude_noise_rad = attitude_noise_rad;
        let [_, _, expected_m, _] = expected(&configuration);
        assert_eq!(expected_m, 0.0);
        let [_, _, height_m, _] = measured(&configuration);
        height_m
    };
    // The predictor's gains are the same up to 1 mrad.
    let prompt = |noise| height(PredictionModel::Paper, noise);
    let (small_m, large_m) = (prompt(2.5e-4), prompt(1e-3));
    assert!((large_m / small_m / 16.0 - 1.0).abs() < 0.3, "{small_m} {large_m}");
    let lagging_m = height(PredictionModel::InnerLoops, 1e-3);
    assert!(lagging_m < large_m / 200.0, "{lagging_m} {large_m}");
}
