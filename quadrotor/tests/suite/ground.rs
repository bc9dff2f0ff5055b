//! A vehicle on the ground: what holds it, and what moves it.

use nalgebra::Vector3;
use quadrotor::{
    Airframe, Configuration, ConfigurationError, Disturbance, Environment, GRAVITY_M_S2, InitialState,
    Inputs, Plant, PlantInputs, PlantSimulation, PlantState, RotorLayout, Simulation, Wrench,
};

/// μ of the ground.
const FRICTION: f64 = 0.7;

fn draggy() -> Airframe {
    Airframe { drag_n_s_m: [0.3; 3], ..Airframe::default() }
}

/// Rotors at rest, stood for a second.
fn standing(airframe: &Airframe) -> (Plant, PlantState) {
    let plant = Plant::new(airframe, &Environment { ground_plane: true });
    let mut state = PlantState::at_rest(&InitialState::default());
    for _ in 0..1_000 {
        state = plant.step(&state, &PlantInputs::default(), 1e-3);
    }
    (plant, state)
}

fn pulled(disturbance: Disturbance) -> PlantInputs {
    PlantInputs { disturbance, ..PlantInputs::default() }
}

#[test]
fn in_a_wind_it_stays_exactly_where_it_stands() {
    let airframe = draggy();
    for layout in [RotorLayout::plus(), RotorLayout::x()] {
        let (plant, start) = standing(&Airframe { layout, ..airframe });
        let wind = pulled(Disturbance { wind_m_s: Vector3::new(3.0, -4.0, 0.0), ..Disturbance::default() });
        let mut state = start;
        for _ in 0..60_000 {
            state = plant.step(&state, &wind, 1e-3);
        }
        assert_eq!(state.body.position_m.xy(), start.body.position_m.xy());
        assert_eq!(state.body.velocity_m_s.xy().norm(), 0.0);
        let turned = state.body.rotation().angle_to(&start.body.rotation());
        assert!(turned < 1e-12, "{turned}");
        // An accelerometer feels nothing sideways either.
        assert_eq!(plant.acceleration_m_s2(&state, &wind).xy().norm(), 0.0);
    }
}

/// Just below μ N it stays, just above it slips away, along the force; and it is held again when the force ends.
#[test]
fn it_lets_go_above_the_static_limit() {
    let (plant, start) = standing(&draggy());
    let limit_n = FRICTION * plant.airframe().weight_n();
    let after_a_second = |force: f64| {
        let push = pulled(Disturbance { force_n: Vector3::new(0.0, force, 0.0), ..Disturbance::default() });
        (0..1_000).fold(start, |state, _| plant.step(&state, &push, 1e-3))
    };
    assert_eq!(after_a_second(0.99 * limit_n).body.position_m.y, start.body.position_m.y);
    let slid = after_a_second(1.5 * limit_n);
    // Half of μ g is left over: 3.4 m/s².
    let expected_m = 0.25 * FRICTION * GRAVITY_M_S2;
    assert!((slid.body.position_m.y - expected_m).abs() < 0.2 * expected_m, "{slid:?}");
    assert!(slid.body.position_m.x.abs() < 1e-9);
    let stopped = (0..2_000).fold(slid, |state, _| plant.step(&state, &PlantInputs::default(), 1e-3));
    assert_eq!(stopped.body.velocity_m_s.xy().norm(), 0.0);
}

/// Torque about the vertical: r μ N holds it.
#[test]
fn it_turns_above_the_static_limit_of_its_feet() {
    let (plant, start) = standing(&Airframe::default());
    let airframe = plant.airframe();
    let limit_n_m = FRICTION * airframe.weight_n() * airframe.arm_length_m;
    let turned = |torque: f64| {
        let wrench = Wrench { thrust_n: 0.0, torque_n_m: Vector3::new(0.0, 0.0, torque) };
        let end = (0..500).fold(start, |state, _| plant.step(&state, &PlantInputs::wrench(wrench), 1e-3));
        end.body.rotation().euler_angles().2
    };
    assert!(turned(0.99 * limit_n_m).abs() < 1e-12);
    assert!(turned(1.5 * limit_n_m) > 0.05);
}

/// Dropped, aslant and sliding: the ground only takes energy, also when it holds the vehicle at last.
#[test]
fn a_landing_does_not_gain_energy() {
    let airframe = Airframe::default();
    let plant = Plant::new(&airframe, &Environment { ground_plane: true });
    let inertia = Vector3::from(airframe.inertia_kg_m2);
    // What the compliant feet hold is at most what came in: looked at is what is left above them.
    let energy = |state: &PlantState| {
        let (body, rate) = (&state.body, state.body.body_rate_rad_s);
        let springs: f64 = airframe
            .layout
            .rotors
            .iter()
            .map(|rotor| {
                let foot = Vector3::new(rotor.x, rotor.y, 0.0) * airframe.arm_length_m;
                let depth = (body.position_m.z + (body.rotation() * foot).z).max(0.0);
                airframe.mass_kg / 4.0 * 2500.0 * depth * depth / 2.0
            })
            .sum();
        airframe.mass_kg * (body.velocity_m_s.norm_squared() / 2.0 - GRAVITY_M_S2 * body.position_m.z)
            + rate.dot(&inertia.component_mul(&rate)) / 2.0
            + springs
    };
    let initial = InitialState {
        position_m: [0.0, 0.0, -0.3],
        velocity_m_s: [0.8, -0.3, 0.0],
        attitude_rad: [0.05, -0.03, 0.4],
        body_rate_rad_s: [0.0, 0.0, 1.0],
        ..InitialState::default()
    };
    let mut state = PlantState::at_rest(&initial);
    let mut before = energy(&state);
    for _ in 0..5_000 {
        state = plant.step(&state, &PlantInputs::default(), 1e-3);
        let after = energy(&state);
        assert!(after <= before + 1e-6, "{before} J became {after} J: {state:?}");
        before = after;
    }
    assert_eq!(state.body.velocity_m_s.xy().norm(), 0.0);
}

/// The same rule in a flight: disarmed it stands in the wind, armed it takes off from there.
#[test]
fn a_flight_begins_where_the_vehicle_stood() {
    let mut configuration = Configuration { airframe: draggy(), ..Configuration::default() };
    configuration.environment.ground_plane = true;
    let mut inputs = Inputs { armed: false, ..Inputs::default() };
    inputs.disturbance.wind_m_s = Vector3::new(5.0, 0.0, 0.0);
    let mut flight = Simulation::new(&configuration, &inputs).unwrap();
    // It begins without load on its feet, and sinks 4 mm.
    flight.advance_to(1_000_000, &inputs).unwrap();
    let stands = flight.outputs().position_m.xy();
    assert!(stands.norm() < 1e-4);
    flight.advance_to(60_000_000, &inputs).unwrap();
    assert_eq!(flight.outputs().position_m.xy(), stands);
    inputs.armed = true;
    flight.advance_to(80_000_000, &inputs).unwrap();
    assert!((flight.outputs().position_m - inputs.reference.position_m).norm() < 0.01);
}

fn over_ground(z_m: f64, attitude_rad: [f64; 3]) -> Configuration {
    let initial = InitialState { position_m: [0.0, 0.0, z_m], attitude_rad, ..InitialState::default() };
    Configuration { environment: Environment { ground_plane: true }, initial, ..Configuration::default() }
}

#[test]
fn a_start_below_the_ground_is_refused_with_the_allowed_range() {
    for (z_m, attitude_rad) in
        [(1.0, [0.0; 3]), (0.011, [0.0; 3]), (0.0, [0.0, 0.2, 1.0]), (1e6, [1.0, 0.5, 0.0])]
    {
        let error = Simulation::new(&over_ground(z_m, attitude_rad), &Inputs::default()).unwrap_err();
        let ConfigurationError::BelowGround { z_m: refused_m, greatest_m, .. } = error else {
            panic!("{error}")
        };
        assert_eq!(refused_m, z_m);
        assert!(Simulation::new(&over_ground(greatest_m, attitude_rad), &Inputs::default()).is_ok());
        // Without ground there is nothing to start below.
        let mut free = over_ground(z_m, attitude_rad);
        free.environment.ground_plane = false;
        assert!(Simulation::new(&free, &Inputs::default()).is_ok());
    }
    let message = Simulation::new(&over_ground(2.0, [0.0; 3]), &Inputs::default()).unwrap_err().to_string();
    assert_eq!(
        message,
        "initial.position.z = 2 m is below the ground (z points down); with environment.ground_plane = true and this \
         initial attitude, allowed up to 0.010 m"
    );
}

/// From the greatest allowed z no attitude is thrown up: without thrust nothing can gain height.
#[test]
fn an_allowed_start_does_not_throw_the_vehicle_up() {
    let inputs = Inputs { armed: false, ..Inputs::default() };
    for [phi, theta] in [[0.0, 0.0], [0.3, 0.0], [0.0, -0.8], [0.5, 0.5], [3.1, 0.2]] {
        let attitude_rad = [phi, theta, 0.7];
        let refused = Simulation::new(&over_ground(1e3, attitude_rad), &inputs).unwrap_err();
        let ConfigurationError::BelowGround { greatest_m, .. } = refused else { panic!("{refused}") };
        let mut flight = Simulation::new(&over_ground(greatest_m, attitude_rad), &inputs).unwrap();
        for ms in 1..=2_000 {
            flight.advance_to(ms * 1_000, &inputs).unwrap();
            let risen_m = greatest_m - flight.outputs().position_m.z;
            assert!(risen_m < 0.02, "{attitude_rad:?}: {risen_m} m after {ms} ms");
        }
    }
}

/// On ground with a height, the deepest start is that of flat ground, as much higher or lower as the ground is.
#[test]
fn a_flight_does_not_start_below_raised_ground() {
    let begin = |z_m: f64| {
        let inputs = Inputs { ground_z_m: PLATEAU_Z_M, ..Inputs::default() };
        Simulation::new(&over_ground(z_m, [0.0; 3]), &inputs).map(drop)
    };
    assert_eq!(begin(PLATEAU_Z_M), Ok(()));
    let refused = begin(0.0).expect_err("twelve metres deep");
    let ConfigurationError::BelowGround { greatest_m, .. } = refused else { panic!("{refused}") };
    assert!((greatest_m - PLATEAU_Z_M - 0.01).abs() < 1.1e-3, "{greatest_m}");
    assert_eq!(begin(greatest_m), Ok(()));
    let expected = "initial.position.z = 0 m is below the ground at ground.z = -12 m (z points down); with \
        environment.ground_plane = true and this initial attitude, allowed up to -11.990 m";
    assert_eq!(refused.to_string(), expected);
    let configuration = over_ground(0.0, [0.0; 3]);
    let plant = PlantSimulation::new(
        &configuration,
        &PlantState::at_rest(&configuration.initial),
        &over_plateau(PlantInputs::default()),
    );
    assert_eq!(plant.map(drop), Err(refused));
}

/// The plant alone starts where it is told to, whatever the configuration's own start is.
#[test]
fn the_start_of_the_plant_is_the_one_that_is_checked() {
    let begin = |configured_z_m: f64, z_m: f64| {
        let start = PlantState::at_rest(&over_ground(z_m, [0.0; 3]).initial);
        let inputs = over_plateau(PlantInputs::default());
        PlantSimulation::new(&over_ground(configured_z_m, [0.0; 3]), &start, &inputs).map(drop)
    };
    assert_eq!(begin(0.0, PLATEAU_Z_M), Ok(()));
    let refused = begin(PLATEAU_Z_M, 0.0);
    assert!(matches!(refused, Err(ConfigurationError::BelowGround { z_m: 0.0, .. })), "{refused:?}");
}

/// z of the top of a plateau, m.
const PLATEAU_Z_M: f64 = -12.0;

fn over_plateau(inputs: PlantInputs) -> PlantInputs {
    PlantInputs { ground_z_m: PLATEAU_Z_M, ..inputs }
}

/// It falls on a plateau, rests g/ω² = 9.81/50² m deep in it, and a wind does not move it.
#[test]
fn it_stands_on_a_plateau_as_on_flat_ground() {
    let plant = Plant::new(&draggy(), &Environment { ground_plane: true });
    let above = InitialState { position_m: [0.0, 0.0, PLATEAU_Z_M - 0.5], ..InitialState::default() };
    let windy = Disturbance { wind_m_s: Vector3::new(3.0, -4.0, 0.0), ..Disturbance::default() };
    let fall = |state, disturbance| {
        let inputs = over_plateau(pulled(disturbance));
        (0..3_000).fold(state, |state, _| plant.step(&state, &inputs, 1e-3))
    };
    let stands = fall(PlantState::at_rest(&above), Disturbance::default());
    let depth_m = stands.body.position_m.z - PLATEAU_Z_M;
    assert!((depth_m - GRAVITY_M_S2 / 2_500.0).abs() < 1e-9, "{depth_m}");
    assert_eq!(fall(stands, windy).body.position_m.xy(), stands.body.position_m.xy());
    // Over its edge it falls on.
    let lower = pulled(Disturbance::default());
    let fallen = (0..100).fold(stands, |state, _| plant.step(&state, &lower, 1e-3));
    assert!((fallen.body.velocity_m_s.z - 0.1 * GRAVITY_M_S2).abs() < 0.05, "{}", fallen.body.velocity_m_s.z);
}

/// Cheeseman and Bennett: T = T∞/(1 − (R/4z)²) at a height z above whatever ground there is.
#[test]
fn the_ground_effect_is_that_of_the_height_above_the_plateau() {
    let mut airframe = Airframe::default();
    airframe.rotor_aerodynamics.ground_effect = true;
    let radius_m = airframe.rotor_aerodynamics.radius_m;
    let plant = Plant::new(&airframe, &Environment { ground_plane: true });
    for height_m in [0.3, 0.5, 1.0] {
        let position_m = [2.0, -1.0, PLATEAU_Z_M - height_m];
        let state = PlantState::hovering(&InitialState { position_m, ..InitialState::default() }, &airframe);
        let inputs = over_plateau(PlantInputs::rotor_speeds(state.rotor_speed_rad_s));
        let share = plant.wrench(&state, &inputs).thrust_n / airframe.weight_n();
        let expected = 1.0 / (1.0 - (radius_m / (4.0 * height_m)).powi(2));
        assert!((share - expected).abs() < 1e-9, "{height_m} m: {share}, expected {expected}");
    }
}

/// A flight stands on the plateau, climbs from it, and learns nothing there that it would not learn on flat ground: all of it is the
/// flight over flat ground, higher up.
#[test]
fn a_flight_from_a_plateau_is_the_one_from_flat_ground() {
    let flown = |ground_z_m: f64| {
        let configuration = over_ground(ground_z_m, [0.0; 3]);
        let mut inputs = Inputs { armed: false, ground_z_m, ..Inputs::default() };
        inputs.reference.position_m = Vector3::new(1.0, 0.0, ground_z_m - 3.0);
        let mut flight = Simulation::new(&configuration, &inputs).unwrap();
        flight.advance_to(1_000_000, &inputs).unwrap();
        inputs.armed = true;
        flight.advance_to(6_000_000, &inputs).unwrap();
        flight.outputs().position_m - Vector3::z() * ground_z_m
    };
    let difference_m = (flown(PLATEAU_Z_M) - flown(0.0)).norm();
    assert!(difference_m < 1e-9, "{difference_m}");
}
