//! Flies a plan.

use quadrotor::{
    Configuration, ConfigurationError, Plant, PlantInputs, PlantState, Simulation, SimulationError,
    wrench_of_rotors,
};
use thiserror::Error;

use super::flyer::Flyer;
use super::geometric::{Geometric, SAMPLE_S};
use super::plan::Plan;
use super::track::{Moment, STEP_US, Track};

/// Integration steps of the plant in a sample of the geometric controller.
const STEPS: u64 = 10;

/// Why there is no flight.
#[derive(Clone, Debug, Error)]
pub enum Lost {
    /// The controllers could not be designed.
    #[error("rejected: {0}")]
    Refused(#[from] ConfigurationError),
    /// The flight diverged.
    #[error("lost: {0}")]
    Diverged(#[from] SimulationError),
}

/// Flies.
///
/// # Errors
/// Why there is no flight.
pub fn fly(plan: &Plan, flyer: Flyer) -> Result<Track, Lost> {
    let configuration = flyer.applied(&plan.configuration);
    if flyer == Flyer::Geometric {
        let controller = Geometric::new(&configuration, |time_s| plan.reference(time_s))?;
        return Ok(fly_plant(plan, &configuration, |time_s, plant| {
            controller.rotor_speeds_rad_s(time_s, plant)
        }));
    }
    fly_loop(plan, &configuration)
}

fn steps(plan: &Plan) -> u64 {
    (plan.duration_s * 1e6) as u64 / STEP_US
}

/// The closed loop.
fn fly_loop(plan: &Plan, configuration: &Configuration) -> Result<Track, Lost> {
    let inputs = |time_us: u64| plan.inputs(time_us);
    let mut simulation = Simulation::new(configuration, &inputs(0))?;
    let mut track = Track::default();
    for step in 0..=steps(plan) {
        let time_us = step * STEP_US;
        simulation.advance_to(time_us, &inputs)?;
        let outputs = simulation.outputs();
        let time_s = time_us as f64 * 1e-6;
        track.moments.push(Moment {
            time_s,
            position_m: outputs.position_m,
            velocity_m_s: outputs.velocity_m_s,
            attitude_rad: outputs.attitude_rad,
            body_rate_rad_s: outputs.body_rate_rad_s,
            thrust_n: outputs.thrust_n,
            torque_n_m: outputs.torque_n_m,
            reference_m: plan.place_m(time_s),
        });
    }
    Ok(track)
}

/// The plant alone, with commands from time and state at each sample.
fn fly_plant(
    plan: &Plan,
    configuration: &Configuration,
    command_rad_s: impl Fn(f64, &PlantState) -> [f64; 4],
) -> Track {
    let plant = Plant::new(&configuration.airframe, &configuration.environment);
    let mut state = PlantState::hovering(&configuration.initial, &configuration.airframe);
    let mut track = Track::default();
    for step in 0..=steps(plan) {
        let time_s = (step * STEP_US) as f64 * 1e-6;
        track.moments.push(Moment::of(
            time_s,
            &state,
            &wrench_of_rotors(plant.airframe(), &state.rotor_speed_rad_s),
            plan.place_m(time_s),
        ));
        let inputs = PlantInputs {
            disturbance: plan.disturbance(time_s),
            ..PlantInputs::rotor_speeds(command_rad_s(time_s, &state))
        };
        for _ in 0..STEPS {
            state = plant.step(&state, &inputs, SAMPLE_S / STEPS as f64);
        }
    }
    track
}
