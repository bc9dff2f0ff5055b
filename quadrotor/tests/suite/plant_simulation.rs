//! The plant alone against the closed loop, and on its own.

use nalgebra::Vector3;
use proptest::prelude::*;
use quadrotor::{
    Configuration, ConfigurationError, Disturbance, Environment, InitialState, Inputs, Outputs, PlantInputs,
    PlantOutputs, PlantSimulation, PlantState, Simulation, SimulationError, Wrench,
};

use crate::common::physics::all_physics;

fn windy(time_us: u64) -> Disturbance {
    Disturbance {
        force_n: Vector3::new(0.0, 0.3 * (time_us as f64 * 2e-6).sin(), 0.0),
        wind_m_s: Vector3::new(3.0, -1.0, 0.2),
        ..Disturbance::default()
    }
}

/// What both have in common.
fn of_closed_loop(outputs: &Outputs) -> PlantOutputs {
    PlantOutputs {
        position_m: outputs.position_m,
        velocity_m_s: outputs.velocity_m_s,
        acceleration_m_s2: outputs.acceleration_m_s2,
        body_velocity_m_s: outputs.body_velocity_m_s,
        attitude_rad: outputs.attitude_rad,
        quaternion: outputs.quaternion,
        body_rate_rad_s: outputs.body_rate_rad_s,
        wrench: Wrench { thrust_n: outputs.thrust_n, torque_n_m: outputs.torque_n_m },
        rotor_speed_rad_s: outputs.rotor_speed_rad_s,
        battery: outputs.battery,
    }
}

/// Driven by the commands that the closed loop applied it follows it, bit for bit, with all physics and from the ground.
#[test]
fn it_follows_the_closed_loop_bit_for_bit() {
    for airframe in [quadrotor::Airframe::default(), all_physics()] {
        let environment = Environment { ground_plane: true };
        let configuration = Configuration { airframe, environment, ..Configuration::default() };
        let inputs = |time_us| Inputs { disturbance: windy(time_us), ..Inputs::default() };
        let mut flight = Simulation::new(&configuration, &inputs(0)).unwrap();
        let start = PlantState::hovering(&configuration.initial, &configuration.airframe);
        let mut plant = PlantSimulation::new(&configuration, &start, &PlantInputs::default()).unwrap();
        for millisecond in 1..=12_000_u64 {
            let (from_us, to_us) = ((millisecond - 1) * 1_000, millisecond * 1_000);
            flight.advance_to(to_us, &inputs).unwrap();
            let applied = PlantInputs {
                disturbance: windy(from_us),
                ..PlantInputs::rotor_speeds(flight.rotor_command_rad_s())
            };
            plant.advance_to(to_us, &|_| applied).unwrap();
            assert_eq!(plant.outputs(), of_closed_loop(&flight.outputs()), "at {millisecond} ms");
        }
        assert!((flight.outputs().position_m - inputs(0).reference.position_m).norm() < 0.5);
    }
}

fn hover() -> (Configuration, PlantState) {
    let configuration = Configuration { airframe: all_physics(), ..Configuration::default() };
    (configuration, PlantState::hovering(&InitialState::default(), &configuration.airframe))
}

/// Commands that change at each point of the grid.
fn restless(time_us: u64) -> PlantInputs {
    let phase = (time_us / 1_000) as f64;
    let command = [0.0, 1.0, 2.0, 3.0].map(|rotor: f64| 270.0 + 20.0 * (0.3 * phase + rotor).sin());
    PlantInputs { disturbance: windy(time_us / 1_000 * 1_000), ..PlantInputs::rotor_speeds(command) }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn any_split_of_the_time_axis_gives_the_same_flight(mut times in prop::collection::vec(0..500_000_u64, 0..60)) {
        let (configuration, start) = hover();
        let new = || PlantSimulation::new(&configuration, &start, &restless(0)).unwrap();
        let (mut whole, mut split) = (new(), new());
        whole.advance_to(500_000, &restless).unwrap();
        times.sort_unstable();
        for time_us in times.into_iter().chain([500_000]) {
            split.advance_to(time_us, &restless).unwrap();
            prop_assert_eq!(split.time_us(), time_us);
            // Observed and saved on the way.
            let bytes = postcard::to_allocvec(&split.state()).unwrap();
            let restored =
                PlantSimulation::from_state(&configuration, postcard::from_bytes(&bytes).unwrap()).unwrap();
            prop_assert_eq!(restored.outputs(), split.outputs());
            split = restored;
        }
        prop_assert_eq!(split, whole);
    }
}

/// A change between two points of the grid acts at once, and until then the old inputs did.
#[test]
fn a_change_acts_where_it_is_made() {
    let (configuration, start) = hover();
    let (slow, fast) = ([250.0; 4], [300.0; 4]);
    let mut simulation =
        PlantSimulation::new(&configuration, &start, &PlantInputs::rotor_speeds(slow)).unwrap();
    let stepped = |state: &PlantState, command, h_s| {
        simulation.plant().step(state, &PlantInputs::rotor_speeds(command), h_s)
    };
    let later = stepped(&stepped(&start, slow, 0.0004), fast, 0.0008);
    simulation.advance_to(400, &|_| PlantInputs::rotor_speeds(slow)).unwrap();
    simulation.advance_to(1_200, &|_| PlantInputs::rotor_speeds(fast)).unwrap();
    assert_eq!(simulation.plant_state(), later);
}

#[test]
fn what_cannot_be_is_refused_by_name() {
    let (configuration, start) = hover();
    let mut simulation = PlantSimulation::new(&configuration, &start, &PlantInputs::default()).unwrap();
    simulation.advance_to(2_000, &|_| PlantInputs::default()).unwrap();
    let backwards = SimulationError::Backwards { time_us: 2_000, requested_us: 1_999 };
    assert_eq!(simulation.advance_to(1_999, &|_| PlantInputs::default()), Err(backwards));
    let not_finite = [
        ("rotor.command", PlantInputs::rotor_speeds([250.0, f64::NAN, 250.0, 250.0])),
        ("command.thrust", PlantInputs::wrench(Wrench { thrust_n: f64::INFINITY, ..Wrench::default() })),
        (
            "command.torque",
            PlantInputs::wrench(Wrench { thrust_n: 1.0, torque_n_m: Vector3::new(0.0, f64::NAN, 0.0) }),
        ),
        (
            "wind.velocity",
            PlantInputs {
                disturbance: Disturbance { wind_m_s: Vector3::repeat(f64::NAN), ..Disturbance::default() },
                ..PlantInputs::default()
            },
        ),
    ];
    for (name, inputs) in not_finite {
        let refused = simulation.advance_to(3_000, &|_| inputs);
        assert_eq!(refused, Err(SimulationError::InputNotFinite { name, time_us: 2_000 }));
    }
    let spun = PlantInputs::wrench(Wrench { thrust_n: 0.0, torque_n_m: Vector3::new(0.0, 0.0, 1e6) });
    let lost = simulation.advance_to(5_000_000, &|_| spun);
    assert!(matches!(lost, Err(SimulationError::Diverged { .. })), "{lost:?}");

    let refused =
        |changed: Configuration| PlantSimulation::new(&changed, &start, &PlantInputs::default()).err();
    let mut impossible = configuration;
    impossible.airframe.products_of_inertia_kg_m2 = [0.2, 0.0, 0.0];
    assert!(matches!(refused(impossible), Some(ConfigurationError::Inertia { .. })));
    let mut buried = configuration;
    buried.environment.ground_plane = true;
    buried.initial.position_m[2] = 1.0;
    assert!(matches!(refused(buried), Some(ConfigurationError::BelowGround { .. })));
    let mut weightless = configuration;
    weightless.airframe.mass_kg = 0.0;
    assert!(matches!(
        refused(weightless),
        Some(ConfigurationError::OutOfRange { name: "airframe.mass", .. })
    ));
    // What nobody could control may fly alone.
    let mut heavy = configuration;
    heavy.airframe.mass_kg = 40.0;
    heavy.limits.tilt_rad = -1.0;
    assert_eq!(refused(heavy), None);
}
