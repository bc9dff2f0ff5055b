//! The closed loop, alone and in a fleet, and the plant alone, as fast as they go.

use std::num::NonZeroUsize;

use quadrotor::{
    Configuration, Fleet, Inputs, PlantInputs, PlantSimulation, PlantState, PositionReference,
    ReferenceSettings, Simulation,
};
use serde::Serialize;

use crate::Failure;
use crate::median::median;
use crate::stopwatch::Stopwatch;

/// Longest step of integration of both, s, which calm flight takes, and the order of its method.
const STEP_S: f64 = 5e-3;
const ORDER: u32 = 4;
/// Vehicles of the fleet.
const VEHICLES: u32 = 64;

/// Figures of the engine; times are medians over repetitions.
#[derive(Serialize)]
pub struct Figures {
    step_s: f64,
    order: u32,
    simulated_s: f64,
    /// ns per simulated second.
    closed_loop_ns: f64,
    /// The same without the shaper: the controllers meet their limits.
    raw_goal_ns: f64,
    /// The same of one of many vehicles that fly on one core.
    fleet_ns: f64,
    plant_ns: f64,
    outputs_ns: f64,
    design_ns: f64,
    /// Bytes of a closed loop.
    memory_bytes: usize,
}

/// Flies.
///
/// # Errors
/// When the defaults are refused.
pub fn measure(quick: bool) -> Result<Figures, Failure> {
    let repetitions = if quick { 5 } else { 15 };
    let seconds = if quick { 5 } else { 20 };
    let configuration = Configuration::default();
    let raw = Configuration { reference: ReferenceSettings { shaping: false }, ..configuration };
    let start = Simulation::new(&configuration, &Inputs::default())?;
    let held = allocation_counter::measure(|| std::mem::forget(start.clone())).bytes_current;
    let outputs = || {
        std::hint::black_box(std::hint::black_box(&start).outputs());
    };
    let watch = Stopwatch::calibrated();
    let design = || Simulation::new(&configuration, &Inputs::default()).map(std::hint::black_box).is_ok();
    Ok(Figures {
        step_s: STEP_S,
        order: ORDER,
        simulated_s: f64::from(seconds),
        closed_loop_ns: repeated(repetitions, || closed_loop(&configuration, seconds))?,
        raw_goal_ns: repeated(repetitions, || closed_loop(&raw, seconds))?,
        fleet_ns: repeated(if quick { 1 } else { 3 }, || fleet(&configuration, seconds))?,
        plant_ns: repeated(repetitions, || plant(&configuration, seconds))?,
        outputs_ns: repeated(repetitions, || Ok(watch.time_each(1_000, outputs)))?,
        design_ns: repeated(repetitions, || {
            Ok(watch.time(|| {
                design();
            }))
        })?,
        memory_bytes: size_of::<Simulation>() + usize::try_from(held).unwrap_or_default(),
    })
}

fn repeated(times: usize, mut work: impl FnMut() -> Result<f64, Failure>) -> Result<f64, Failure> {
    Ok(median((0..times).map(|_| work()).collect::<Result<Vec<_>, _>>()?))
}

fn closed_loop(configuration: &Configuration, seconds: u32) -> Result<f64, Failure> {
    let inputs = Inputs::default();
    let mut simulation = Simulation::new(configuration, &inputs)?;
    let mut flown = Ok(());
    let taken_ns =
        Stopwatch::free().time(|| flown = simulation.advance_to(u64::from(seconds) * 1_000_000, &inputs));
    flown?;
    Ok(taken_ns / f64::from(seconds))
}

/// To goals a decimetre apart.
fn fleet(configuration: &Configuration, seconds: u32) -> Result<f64, Failure> {
    let vehicles = vec![*configuration; VEHICLES as usize];
    let inputs = |vehicle: usize| Inputs {
        reference: PositionReference::goal([5.0, 5.0 + 0.1 * vehicle as f64, -10.0], 0.0),
        ..Inputs::default()
    };
    let mut fleet = Fleet::with_threads(&vehicles, inputs, NonZeroUsize::new(1))?;
    let taken_ns = Stopwatch::free().time(|| fleet.advance_to(u64::from(seconds) * 1_000_000, inputs));
    fleet.failures().flatten().next().map_or(Ok(()), |failure| Err(*failure))?;
    Ok(taken_ns / f64::from(seconds * VEHICLES))
}

fn plant(configuration: &Configuration, seconds: u32) -> Result<f64, Failure> {
    let start = PlantState::hovering(&configuration.initial, &configuration.airframe);
    let hover = PlantInputs::rotor_speeds([configuration.airframe.hover_rotor_speed_rad_s(); 4]);
    let mut simulation = PlantSimulation::new(configuration, &start, &hover)?;
    let mut flown = Ok(());
    let taken_ns =
        Stopwatch::free().time(|| flown = simulation.advance_to(u64::from(seconds) * 1_000_000, &|_| hover));
    flown?;
    Ok(taken_ns / f64::from(seconds))
}
