//! How long the controllers take.

use std::time::Instant;

use quadrotor::{
    Configuration, ConfigurationError, ControlInputs, ControlLoop, Measurement, Plant, PlantInputs,
    PlantState, PositionReference, Target,
};

use super::flyer::Flyer;
use super::result::BarResult;

/// Goals whose flights are timed, NED, m: limits of all loops are active on the way.
const GOALS_M: [[f64; 3]; 3] = [[20.0, 0.0, 0.0], [20.0, 20.0, -20.0], [0.0, -100.0, 10.0]];
/// How long each is flown, ms.
const DURATION_MS: u64 = 12_000;
/// Longest 99th percentile, µs, on a machine on which a step of the position controller takes 1 µs.
const BOUND_US: f64 = 10.0;

/// Times of the samples at which all three controllers sample, µs: their 99th percentile.
///
/// # Errors
/// [`ConfigurationError`].
pub fn p99_us(configuration: &Configuration) -> Result<f64, ConfigurationError> {
    let mut times_us = Vec::new();
    for goal_m in GOALS_M {
        times_us.extend(timed_us(configuration, goal_m)?);
    }
    times_us.sort_by(f64::total_cmp);
    let index = times_us.len() * 99 / 100;
    Ok(times_us.get(index).copied().unwrap_or(f64::NAN))
}

fn timed_us(configuration: &Configuration, goal_m: [f64; 3]) -> Result<Vec<f64>, ConfigurationError> {
    let mut configuration = *configuration;
    configuration.reference.shaping = false;
    let plant = Plant::new(&configuration.airframe, &configuration.environment);
    let mut state = PlantState::hovering(&configuration.initial, &configuration.airframe);
    let measured =
        |state: &PlantState| Measurement { motion: state.body, rotor_speed_rad_s: state.rotor_speed_rad_s };
    let inputs = ControlInputs::armed(Target::Reference(PositionReference::goal(goal_m, 0.0)));
    let mut control = ControlLoop::new(&configuration, &inputs, &mut measured(&state), 0)?;
    let controllers = &configuration.controllers;
    let together_us = controllers.position.sample_time_us.max(controllers.altitude.sample_time_us);
    let mut times_us = Vec::new();
    for time_us in (0..DURATION_MS).map(|millisecond| 1000 * millisecond) {
        let begin = Instant::now();
        let command = control.advance_to(time_us, &inputs, &mut measured(&state));
        let taken = begin.elapsed();
        // A vehicle that is lost has no more times.
        let Ok(command_rad_s) = command else { break };
        if time_us % together_us == 0 {
            times_us.push(taken.as_secs_f64() * 1e6);
        }
        state = plant.step(&state, &PlantInputs::rotor_speeds(command_rad_s), 1e-3);
    }
    Ok(times_us)
}

/// The times of some flyers, held against their bar. Measured on this machine, in this build.
pub fn sample_times(configuration: &Configuration, flyers: &[Flyer]) -> Vec<BarResult> {
    flyers
        .iter()
        .filter(|flyer| **flyer != Flyer::Geometric)
        .map(|flyer| {
            let time = p99_us(&flyer.applied(configuration));
            BarResult {
                row: "sample-time",
                flight: "raw goals of 20 to 100 m".to_owned(),
                controller: flyer.name().to_owned(),
                figure: "99th percentile of a sample of all three loops, µs",
                value: time.as_ref().ok().copied().filter(|time| time.is_finite()),
                bound: Some(BOUND_US),
                passed: Some(time.as_ref().is_ok_and(|time_us| *time_us <= BOUND_US)),
                lost: time.err().map(|error| error.to_string()),
            }
        })
        .collect()
}
