//! A fleet flies as its vehicles do alone.

use std::num::NonZeroUsize;

use quadrotor::{
    Configuration, ControllerKind, Disturbance, Fleet, FleetError, Inputs, Sensors, Simulation,
    SimulationError,
};

use crate::common::{goal, unshaped};

const VEHICLES: usize = 13;
const END_US: u64 = 1_500_300;

/// Three kinds of vehicles, with noise of their own.
fn configuration(vehicle: usize) -> Configuration {
    let mut configuration = unshaped();
    configuration.controllers.kind =
        [ControllerKind::Lmpc, ControllerKind::StateSpaceMpc, ControllerKind::Dlqr][vehicle % 3];
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
    fleet
        .change_each(|vehicle, simulation| {
            if vehicle != 4 {
                return Ok(false);
            }
            simulation.restore(starts[vehicle]).map(|()| true)
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
