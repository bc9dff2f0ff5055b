//! The same flight however it is split, saved or observed.

use nalgebra::{UnitQuaternion, Vector3};
use proptest::prelude::*;
use quadrotor::{
    AttitudeTarget, Configuration, ConfigurationError, Disturbance, InputSignal, Inputs, PlantInputs,
    Sensors, Simulation, SimulationError,
};

use crate::common::{GOAL_M, KINDS, goal, smooth_flight, unshaped};

/// A flight with a wind that changes and a goal that jumps, so that every part has something to do.
fn eventful(time_us: u64) -> Inputs {
    let mut inputs = if time_us < 1_500_000 { goal(GOAL_M, 0.4) } else { goal([-3.0, 8.0, -6.0], -1.0) };
    inputs.disturbance.force_n.x = (time_us as f64 * 3e-6).sin();
    inputs.disturbance.torque_n_m.y = 0.01 * (time_us as f64 * 5e-6).cos();
    inputs
}

/// Any kind of controller on noisy outputs alone: active sets, estimates and noise are part of the state.
fn noisy(kind: usize) -> Configuration {
    let mut configuration = Configuration::default();
    configuration.controllers.kind = KINDS[kind];
    configuration.sensors = Sensors {
        output_feedback: true,
        position_noise_m: 0.03,
        attitude_noise_rad: 0.005,
        seed: 3,
        ..Sensors::default()
    };
    configuration
}

fn flown_to(configuration: &Configuration, times_us: &[u64]) -> Simulation {
    let mut simulation = Simulation::new(configuration, &eventful(0)).unwrap();
    for &time_us in times_us {
        simulation.advance_to(time_us, &eventful).unwrap();
    }
    simulation
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn any_split_of_the_time_axis_gives_the_same_flight(
        mut times in prop::collection::vec(0u64..3_000_000, 0..200), shaping in any::<bool>(), kind in 0..3_usize,
    ) {
        let mut configuration = noisy(kind);
        configuration.reference.shaping = shaping;
        times.sort_unstable();
        times.push(3_000_000);
        let split = flown_to(&configuration, &times);
        let whole = flown_to(&configuration, &[3_000_000]);
        prop_assert_eq!(split.state(), whole.state());
        prop_assert_eq!(split.outputs(), whole.outputs());
    }

    /// In calm flight the plant takes long steps, which end where an input changes.
    #[test]
    fn any_split_around_a_rare_change_gives_the_same_flight(
        mut times in prop::collection::vec(0u64..200_000, 0..60), change_us in 0u64..200_000, shaping in any::<bool>(),
    ) {
        let mut configuration = Configuration::default();
        configuration.reference.shaping = shaping;
        let inputs = |time_us: u64| {
            let mut inputs = goal(GOAL_M, 0.4);
            inputs.disturbance.force_n.y = if time_us < change_us { 0.0 } else { 1.0 };
            inputs
        };
        let start = Simulation::new(&configuration, &inputs(0)).unwrap();
        let (mut whole, mut split, mut stepped) = (start.clone(), start.clone(), start);
        whole.advance_to(200_000, &inputs).unwrap();
        times.sort_unstable();
        for time_us in times.into_iter().chain([200_000]) {
            split.advance_to(time_us, &inputs).unwrap();
        }
        // Each millisecond under inputs that are constant until the next.
        for time_us in (0..200_000).step_by(1_000) {
            stepped.advance_to(time_us + 1_000, &inputs(time_us)).unwrap();
        }
        prop_assert_eq!(split.state(), whole.state());
        prop_assert_eq!(stepped.state(), whole.state());
    }

    /// Observation at any microsecond agrees with a flight that was stopped there for good.
    #[test]
    fn arrival_is_exact_at_any_microsecond(time_us in 1u64..2_000_000) {
        let configuration = Configuration::default();
        let direct = flown_to(&configuration, &[time_us]);
        prop_assert_eq!(direct.outputs().time_us, time_us);
        // Between events the plant is integrated from the last one: continue a microsecond at a time.
        let near = flown_to(&configuration, &[time_us.saturating_sub(1), time_us]);
        prop_assert_eq!(direct.outputs(), near.outputs());
    }

    #[test]
    fn saved_and_restored_in_the_middle_is_the_same_flight(middle in 1u64..2_999_999, kind in 0..3_usize) {
        let configuration = Configuration { reference: unshaped().reference, ..noisy(kind) };
        let mut straight = flown_to(&configuration, &[middle]);
        let bytes = postcard::to_allocvec(&straight.state()).unwrap();
        straight.advance_to(3_000_000, &eventful).unwrap();
        let mut resumed = Simulation::from_state(&configuration, postcard::from_bytes(&bytes).unwrap()).unwrap();
        resumed.advance_to(3_000_000, &eventful).unwrap();
        prop_assert_eq!(straight.state(), resumed.state());
        // And back again, in the same simulation.
        straight.restore(postcard::from_bytes(&bytes).unwrap()).unwrap();
        straight.advance_to(3_000_000, &eventful).unwrap();
        prop_assert_eq!(straight.state(), resumed.state());
    }
}

#[test]
fn odd_sample_times_keep_their_schedule() {
    let mut configuration = Configuration::default();
    configuration.controllers.position.sample_time_us = 33_333;
    configuration.controllers.altitude.sample_time_us = 47_001;
    configuration.controllers.attitude.sample_time_us = 7_003;
    let whole = flown_to(&configuration, &[20_000_000]);
    let split: Vec<u64> = (1..=20_000).map(|millisecond| millisecond * 1_000).collect();
    assert_eq!(flown_to(&configuration, &split).state(), whole.state());
}

#[test]
fn time_does_not_go_back_and_bad_inputs_are_named() {
    let mut simulation = flown_to(&Configuration::default(), &[1_000_000]);
    let backwards = simulation.advance_to(999_999, &eventful);
    assert_eq!(backwards, Err(SimulationError::Backwards { time_us: 1_000_000, requested_us: 999_999 }));
    let mut inputs = goal(GOAL_M, 0.0);
    inputs.reference.velocity_m_s.y = f64::NAN;
    let error = simulation.advance_to(1_100_000, &inputs).unwrap_err();
    assert_eq!(error, SimulationError::InputNotFinite { name: "reference.velocity", time_us: 1_000_000 });
    // The flight goes on with good ones.
    simulation.advance_to(1_100_000, &goal(GOAL_M, 0.0)).unwrap();
}

/// With constant inputs nothing moves when the controllers are redesigned with the weights they had, and
/// new weights take over without a bump of the torques.
#[test]
fn redesign_in_flight_is_bumpless() {
    let signal = smooth_flight(GOAL_M, 0.5, 10.0);
    let mut configuration = unshaped();
    let mut simulation = Simulation::new(&configuration, &signal.at(0)).unwrap();
    simulation.advance_to(5_000_000, &signal).unwrap();
    let before = simulation.outputs();
    let state = simulation.state();
    configuration.controllers.attitude.increment_weight *= 2.0;
    configuration.controllers.position.increment_weight *= 0.5;
    simulation.reconfigure(&configuration).unwrap();
    assert_eq!(simulation.state(), state);
    simulation.advance_to(5_050_000, &signal).unwrap();
    let after = simulation.outputs();
    assert!((after.torque_n_m - before.torque_n_m).amax() < 0.01);
    assert!((after.thrust_n - before.thrust_n).abs() < 0.05);

    // A bad weight changes nothing.
    let mut bad = configuration;
    bad.controllers.altitude.increment_weight.x = -1.0;
    assert!(simulation.reconfigure(&bad).is_err());
    assert_eq!(*simulation.configuration(), configuration);
}

#[test]
fn a_flight_without_shaping_does_not_allocate() {
    let signal = smooth_flight(GOAL_M, 0.5, 10.0);
    let mut simulation = Simulation::new(&unshaped(), &signal.at(0)).unwrap();
    let allocations = allocation_counter::measure(|| {
        simulation.advance_to(1_000_000, &signal).unwrap();
        let _ = simulation.outputs();
    });
    assert_eq!(allocations.count_total, 0);
}

/// Planning is what allocates, in the trajectory library: so often for a new goal, so often for a new heading, and never between.
#[test]
fn the_shaper_allocates_when_it_plans_and_only_then() {
    const OF_A_WAY: u64 = 4;
    const OF_A_TURN: u64 = 4;
    let first = goal([5.0, 5.0, -10.0], 0.0);
    let mut simulation = Simulation::new(&Configuration::default(), &first).unwrap();
    let mut allocated = |until_us, inputs: &Inputs| {
        let during = || simulation.advance_to(until_us, inputs).unwrap();
        allocation_counter::measure(during).count_total
    };
    allocated(1_000_000, &first);
    assert_eq!(allocated(2_000_000, &first), 0);
    let farther = goal([7.0, -3.0, -12.0], 0.0);
    assert_eq!(allocated(2_100_000, &farther), OF_A_WAY);
    let turned = goal([7.0, -3.0, -12.0], 0.5);
    assert_eq!(allocated(2_200_000, &turned), OF_A_TURN);
    assert_eq!(allocated(3_000_000, &turned), 0);
}

/// Saved states may come from anywhere: bytes of the right form whose clocks contradict one another are refused.
#[test]
fn impossible_states_are_refused() {
    let configuration = unshaped();
    let good = flown_to(&configuration, &[1_000_500]);
    let bytes = postcard::to_allocvec(&good.state()).unwrap();
    // Both clocks, 1 000 500 µs and 1 000 000 µs, stand first, as variable-length integers of three bytes.
    assert_eq!(bytes[..6], [0xb4, 0x88, 0x3d, 0xc0, 0x84, 0x3d]);
    let refused = |clocks: [u8; 6]| {
        let mut forged = bytes.clone();
        forged[..6].copy_from_slice(&clocks);
        let state = postcard::from_bytes(&forged).unwrap();
        matches!(Simulation::from_state(&configuration, state), Err(ConfigurationError::State { .. }))
    };
    assert!(!refused([0xb4, 0x88, 0x3d, 0xc0, 0x84, 0x3d]));
    // The event after the present, then long before it.
    assert!(refused([0xc0, 0x84, 0x3d, 0xb4, 0x88, 0x3d]));
    assert!(refused([0xb4, 0x88, 0x3d, 0x80, 0x80, 0x01]));
}

/// Inputs that stay as they are need no look while no controller samples, and fly as those that are asked for again and again.
#[test]
fn constant_inputs_fly_as_those_that_are_asked_for() {
    let wind = Vector3::new(3.0, -2.0, 0.0);
    let windy =
        Inputs { disturbance: Disturbance { wind_m_s: wind, ..Disturbance::default() }, ..goal(GOAL_M, 0.4) };
    let attitude = UnitQuaternion::from_euler_angles(0.1, -0.1, 0.4);
    let target = AttitudeTarget { attitude, body_rate_rad_s: Vector3::zeros(), thrust_n: 7.0 };
    for inputs in [
        windy,
        Inputs { armed: false, ..windy },
        Inputs { attitude_target: Some(target), ..windy },
        Inputs { lost_rotor: Some(1), ..windy },
        Inputs { shaping: Some(false), ..windy },
    ] {
        let mut known = Simulation::new(&Configuration::default(), &windy).unwrap();
        let mut asked = known.clone();
        for time_us in [403_500, 1_217_000] {
            known.advance_to(time_us, &inputs).unwrap();
            asked.advance_to(time_us, &|_| inputs).unwrap();
            assert_eq!(known, asked, "{inputs:?}");
        }
    }
}

/// The attitude controller samples at 1.000 and 1.010 s. In between a push acts, rotors stop, and what is not finite is refused.
/// Between two samples of the attitude controller there are two steps.
#[test]
fn calm_flight_takes_long_steps() {
    let inputs = goal(GOAL_M, 0.4);
    let mut flight = Simulation::new(&Configuration::default(), &inputs).unwrap();
    let mut after = |time_us: u64| {
        flight.advance_to(time_us, &inputs).unwrap();
        (flight.plant_state(), PlantInputs::rotor_speeds(flight.rotor_command_rad_s()), *flight.plant())
    };
    // The sample at 500 ms belongs to what follows.
    after(501_000);
    let (middle, command, plant) = after(505_000);
    assert_eq!(after(509_000).0, plant.step(&middle, &command, 0.004));
    assert_eq!(after(510_000).0, plant.step(&middle, &command, 0.005));
}

#[test]
fn inputs_are_looked_at_between_the_samples_of_the_controllers() {
    let flown = |change: fn(&mut Inputs)| {
        let inputs = |time_us: u64| {
            let mut inputs = goal(GOAL_M, 0.4);
            if time_us >= 1_003_000 {
                change(&mut inputs);
            }
            inputs
        };
        let mut flight = Simulation::new(&Configuration::default(), &inputs(0)).unwrap();
        flight.advance_to(1_004_000, &inputs).map(|()| flight)
    };
    let calm = flown(|_| {}).unwrap();
    let pushed = flown(|inputs| inputs.disturbance.force_n.x = 0.7).unwrap();
    let gained_m_s = pushed.plant_state().body.velocity_m_s.x - calm.plant_state().body.velocity_m_s.x;
    assert!((gained_m_s - 1e-3).abs() < 1e-9, "{gained_m_s}");
    let disarmed = flown(|inputs| inputs.armed = false).unwrap();
    assert_eq!(disarmed.rotor_command_rad_s(), [0.0; 4]);
    let refused = flown(|inputs| inputs.reference.yaw_rad = f64::NAN).unwrap_err();
    assert_eq!(refused, SimulationError::InputNotFinite { name: "reference.yaw", time_us: 1_003_000 });
}
