//! A fleet flies as its vehicles do alone.

use std::num::NonZeroUsize;

use quadrotor::{
    Configuration, Disturbance, Fleet, FleetError, Inputs, RotorFault, Sensors, Simulation, SimulationError,
};

use crate::common::physics::all_physics;
use crate::common::{KINDS, goal, unshaped};

const VEHICLES: usize = 13;
const END_US: u64 = 1_500_300;

/// Three kinds of vehicles, with noise of their own.
fn configuration(vehicle: usize) -> Configuration {
    let mut configuration = unshaped();
    configuration.controllers.kind = KINDS[vehicle % 3];
    configuration.sensors =
        Sensors { position_noise_m: 0.01, seed: vehicle as u32 / 6, ..Sensors::default() };
    configuration
}

fn inputs(vehicle: usize) -> Inputs {
    goal([vehicle as f64, 2.0, -3.0], 0.1 * vehicle as f64)
}

fn configurations() -> Vec<Configuration> {
    (0..VEHICLES).map(configuration).collect()
}

#[test]
fn each_flight_is_that_of_a_vehicle_alone_on_any_number_of_threads() {
    for threads in [1, 2, 5] {
        let mut fleet = Fleet::with_threads(&configurations(), inputs, NonZeroUsize::new(threads)).unwrap();
        fleet.advance_to(400_700, inputs);
        fleet.advance_to(END_US, inputs);
        let outputs = fleet.outputs();
        for (vehicle, flown) in fleet.vehicles().enumerate() {
            let mut alone = Simulation::new(&configuration(vehicle), &inputs(vehicle)).unwrap();
            alone.advance_to(END_US, &inputs(vehicle)).unwrap();
            assert_eq!(flown.state(), alone.state(), "vehicle {vehicle} on {threads} threads");
            assert_eq!(outputs[vehicle], alone.outputs());
        }
    }
}

/// A push of a meganewton ends one flight; the others fly on, and a restart brings it back.
#[test]
fn a_vehicle_that_is_lost_is_lost_alone() {
    let pushed = |vehicle: usize| {
        let mut inputs = inputs(vehicle);
        if vehicle == 4 {
            inputs.disturbance = Disturbance { torque_n_m: [1e6, 0.0, 0.0].into(), ..Disturbance::default() };
        }
        inputs
    };
    let mut fleet = Fleet::new(&configurations(), inputs).unwrap();
    let starts = fleet.map(|_, simulation| simulation.state());
    fleet.advance_to(END_US, pushed);
    let lost: Vec<usize> =
        fleet.failures().enumerate().filter_map(|(vehicle, failure)| failure.map(|_| vehicle)).collect();
    assert_eq!(lost, [4]);
    assert!(matches!(fleet.failures().nth(4).unwrap(), Some(SimulationError::Diverged { .. })));
    assert!(
        fleet
            .outputs()
            .iter()
            .enumerate()
            .all(|(vehicle, outputs)| { (outputs.time_us == END_US) == (vehicle != 4) })
    );
    // What has failed stays where it is.
    let stood = fleet.vehicles().nth(4).unwrap().time_us();
    fleet.advance_to(END_US + 1_000, inputs);
    assert_eq!(fleet.vehicles().nth(4).unwrap().time_us(), stood);
    let restarted = |vehicle: usize, simulation: &Simulation| {
        let mut restarted = simulation.clone();
        restarted.restore(starts[vehicle]).map(|()| restarted)
    };
    // All or none: nothing has changed when one of them is refused.
    let before = fleet.outputs();
    let refused =
        fleet.replace_each(
            |vehicle, simulation| {
                if vehicle == 6 { Err(vehicle) } else { Ok(restarted(vehicle, simulation).ok()) }
            },
        );
    assert_eq!(refused, Err(6));
    assert_eq!(fleet.outputs(), before);
    assert!(fleet.failures().nth(4).unwrap().is_some());
    fleet
        .replace_each(|vehicle, simulation| {
            (vehicle == 4).then(|| restarted(vehicle, simulation)).transpose()
        })
        .unwrap();
    fleet.advance_to(END_US + 2_000, inputs);
    assert!(fleet.failures().all(|failure| failure.is_none()));
    assert_eq!(fleet.vehicles().nth(4).unwrap().time_us(), END_US + 2_000);
}

#[test]
fn the_vehicle_that_cannot_fly_is_named() {
    let mut configurations = configurations();
    configurations[7].airframe.mass_kg = 49.0;
    let refused = Fleet::new(&configurations, inputs).unwrap_err();
    assert!(matches!(refused, FleetError::Configuration { vehicle: 7, .. }), "{refused}");
    assert!(Fleet::new(&[], inputs).unwrap().is_empty());
}

/// Vehicles of two airframes, in winds of their own, some on the ground, one with a weak rotor, one with noise.
fn of_all_kinds(vehicle: usize) -> (Configuration, Inputs) {
    let mut configuration = unshaped();
    configuration.environment.ground_plane = true;
    if vehicle.is_multiple_of(2) {
        configuration.airframe = all_physics();
    }
    configuration.sensors.seed = (vehicle % 5) as u32;
    configuration.sensors.position_noise_m = if vehicle == 3 { 0.01 } else { 0.0 };
    configuration.initial.position_m[2] = if vehicle.is_multiple_of(7) { 0.0 } else { -2.0 };
    let mut inputs = goal([0.3 * vehicle as f64, -1.0, -2.5], 0.1);
    inputs.armed = vehicle != 14;
    inputs.disturbance.wind_m_s = [vehicle as f64 * 0.2, -0.5, 0.1].into();
    inputs.rotor_faults[1] = (vehicle == 6).then_some(RotorFault::Weak { share: 0.9 });
    (configuration, inputs)
}

/// The plants of vehicles that are alike step at once: the doubles are those of each alone.
#[test]
fn with_all_physics_each_flight_is_that_of_a_vehicle_alone_bit_for_bit() {
    const COUNT: usize = 17;
    let configurations: Vec<Configuration> = (0..COUNT).map(|vehicle| of_all_kinds(vehicle).0).collect();
    let inputs = |vehicle: usize| of_all_kinds(vehicle).1;
    let mut fleet = Fleet::with_threads(&configurations, inputs, NonZeroUsize::new(2)).unwrap();
    // One is ahead of the others, and then waits for them.
    fleet.vehicles_mut().nth(5).unwrap().advance_to(333_300, &inputs(5)).unwrap();
    for time_us in [400_500, 777_100, END_US] {
        fleet.advance_to(time_us, inputs);
    }
    for (vehicle, flown) in fleet.vehicles().enumerate() {
        let mut alone = Simulation::new(&configurations[vehicle], &inputs(vehicle)).unwrap();
        alone.advance_to(END_US, &inputs(vehicle)).unwrap();
        assert_eq!(flown.state(), alone.state(), "vehicle {vehicle}");
        let bits = |simulation: &Simulation| simulation.plant_state().to_array().map(f64::to_bits);
        assert_eq!(bits(flown), bits(&alone), "vehicle {vehicle}");
    }
}
