//! The plant behind the interface: its run is the engine's, its equations are those of its run, its derivatives are exact.

#[path = "../../quadrotor/tests/suite/common/physics.rs"]
mod physics;

use fmi::variables::{Field, Role, Signal, Variable};
use fmi::{Continuous, Model, Seed};
use fmu::{ClosedLoop, Commands, Drive, FlightError, QuadrotorPlant, Settings};
use nalgebra::Vector3;
use physics::all_physics;
use proptest::prelude::*;
use quadrotor::{
    Airframe, AirframePreset, Configuration, Disturbance, Environment, GRAVITY_M_S2, Inputs, PlantState,
    RotorSpin, Wrench,
};

fn equations() -> &'static dyn Continuous<QuadrotorPlant> {
    QuadrotorPlant::CONTINUOUS.unwrap()
}

fn rows<M: Model>() -> impl Iterator<Item = &'static Variable<M>> {
    M::VARIABLES.iter().copied().flatten()
}

type Reader<M> = fn(&<M as Model>::Outputs) -> f64;

/// Real outputs and derivatives: name and reader.
fn unknowns<M: Model>() -> Vec<(&'static str, Reader<M>)> {
    let reader = |row: &'static Variable<M>| match row.role {
        Role::Output { signal: Signal::Real { get, .. }, .. } | Role::Derivative { get, .. } => {
            Some((row.name, get))
        }
        _ => None,
    };
    rows::<M>().filter_map(reader).collect()
}

/// Names of the states, in their order.
fn states() -> Vec<&'static str> {
    let state = |row: &'static Variable<QuadrotorPlant>| match row.role {
        Role::Derivative { of, .. } => Some(of),
        _ => None,
    };
    rows().filter_map(state).collect()
}

type Setter = fn(&mut Commands, f64);

/// Real inputs: name and writer.
fn inputs() -> Vec<(&'static str, Setter)> {
    let writer = |row: &'static Variable<QuadrotorPlant>| match row.role {
        Role::Input(Field::Real { set, .. }) => Some((row.name, set)),
        _ => None,
    };
    rows().filter_map(writer).collect()
}

fn read(observed: &<QuadrotorPlant as Model>::Outputs) -> Vec<f64> {
    unknowns::<QuadrotorPlant>().iter().map(|(_, get)| get(observed)).collect()
}

fn value(model: &QuadrotorPlant, name: &str) -> f64 {
    let unknowns = unknowns::<QuadrotorPlant>();
    let (_, get) = unknowns.iter().find(|(other, _)| *other == name).unwrap();
    get(&model.outputs())
}

/// The same with one lag for rising and falling rotors: where those meet their commands differences would cross a kink.
fn one_lag() -> Airframe {
    let airframe = all_physics();
    Airframe { rotor_spin: RotorSpin { fall_time_ratio: 1.0, ..airframe.rotor_spin }, ..airframe }
}

fn settings(airframe: Airframe, drive: Drive) -> Settings {
    let environment = Environment { ground_plane: true };
    let configuration = Configuration { airframe, environment, ..Configuration::default() };
    Settings { configuration, drive, ..Settings::default() }
}

/// Driven by the commands of the closed loop all outputs that both have are the same, bit for bit.
#[test]
fn it_follows_the_closed_loop() {
    let settings = settings(all_physics(), Drive::RotorSpeeds);
    let disturbance = Disturbance { wind_m_s: Vector3::new(2.0, -1.0, 0.0), ..Disturbance::default() };
    let asked = Inputs { disturbance, ..Inputs::default() };
    let mut flight = quadrotor::Simulation::new(&settings.configuration, &asked).unwrap();
    let mut commands = Commands { disturbance, ..Commands::default() };
    let mut plant = QuadrotorPlant::new(&settings, &commands).unwrap();
    let plants = unknowns::<QuadrotorPlant>();
    let shared: Vec<_> = unknowns::<ClosedLoop>()
        .into_iter()
        .filter_map(|(name, get)| Some((name, get, plants.iter().find(|(other, _)| *other == name)?.1)))
        .collect();
    assert_eq!(shared.len(), 34);
    for millisecond in 1..=3_000 {
        flight.advance_to(1_000 * millisecond, &asked).unwrap();
        commands.rotor_rad_s = flight.rotor_command_rad_s();
        plant.advance_to(1_000 * millisecond, &|_| commands).unwrap();
        let (expected, found) = (flight.outputs(), plant.outputs());
        for (name, expected_of, found_of) in &shared {
            assert_eq!(found_of(&found), expected_of(&expected), "{name} at {millisecond} ms");
        }
    }
    assert!(flight.outputs().position_m.z < -1.0);
}

/// In a climb F/m − g, with a failed rotor and with less mass; and the same with thrust in place of rotors.
#[test]
fn commands_and_parameters_act() {
    let mut settings = Settings::default();
    let mut commands = Commands::default();
    let mut plant = QuadrotorPlant::new(&settings, &commands).unwrap();
    assert!(value(&plant, "acceleration.z").abs() < 1e-12, "it hovers at first");
    plant.advance_to(2_000_000, &|_| commands).unwrap();
    let thrust_n = 4.0 * 2.7e-5 * 260.0 * 260.0;
    assert!((value(&plant, "acceleration.z") - (GRAVITY_M_S2 - thrust_n / 0.7)).abs() < 1e-9);
    settings.configuration.airframe.mass_kg = 0.5;
    plant.retune(&settings).unwrap();
    assert!((value(&plant, "acceleration.z") - (GRAVITY_M_S2 - thrust_n / 0.5)).abs() < 1e-9);
    settings.configuration.airframe.products_of_inertia_kg_m2[0] = 50.0;
    assert!(matches!(plant.retune(&settings), Err(FlightError::Configuration(_))));
    commands.failed[2] = true;
    plant.advance_to(4_000_000, &|_| commands).unwrap();
    assert!(value(&plant, "rotor.speed[3]") < 1e-9 && value(&plant, "rotor.speed[1]") > 259.0);

    let settings = Settings { drive: Drive::Wrench, ..Settings::default() };
    commands.wrench = Wrench { thrust_n: 9.0, torque_n_m: Vector3::new(0.0, 0.0, 0.2122) };
    let mut plant = QuadrotorPlant::new(&settings, &commands).unwrap();
    assert!((value(&plant, "acceleration.z") - (GRAVITY_M_S2 - 9.0 / 0.7)).abs() < 1e-12);
    plant.advance_to(1_000_000, &|_| commands).unwrap();
    assert!((value(&plant, "body_rate.r") - 1.0).abs() < 1e-12);
    assert_eq!((value(&plant, "thrust"), value(&plant, "rotor.speed[1]")), (9.0, 0.0));
}

#[test]
fn a_saved_state_continues() {
    let settings = settings(all_physics(), Drive::RotorSpeeds);
    let commands = |time_us: u64| Commands {
        rotor_rad_s: [250.0 + (time_us / 7_000) as f64, 255.0, 252.0, 254.0],
        ..Commands::default()
    };
    let mut model = QuadrotorPlant::new(&settings, &commands(0)).unwrap();
    model.advance_to(100_300, &commands).unwrap();
    let saved = model.state();
    let mut other = QuadrotorPlant::from_state(&settings, &saved).unwrap();
    for run in [&mut model, &mut other] {
        run.advance_to(200_000, &commands).unwrap();
    }
    assert_eq!(read(&model.outputs()), read(&other.outputs()));
    assert_ne!(model.state(), saved);
}

/// Only what the plant depends on, under the names of the closed loop; the airframe may change in flight.
#[test]
fn parameters_are_those_that_concern_the_plant() {
    let mut tunable = 0;
    for row in rows::<QuadrotorPlant>().filter(|row| matches!(row.role, Role::Parameter { .. })) {
        let known = rows::<ClosedLoop>().any(|other| other.name == row.name);
        assert!(known || ["actuation", "initial.hovering"].contains(&row.name), "{}", row.name);
        let of_plant = ["airframe.", "environment.", "initial.", "actuation"];
        assert!(of_plant.iter().any(|group| row.name.starts_with(group)), "{}", row.name);
        let Role::Parameter { tunable: in_flight, .. } = row.role else { panic!("{}", row.name) };
        assert_eq!(
            in_flight,
            row.name.starts_with("airframe.") && row.name != "airframe.preset",
            "{}",
            row.name
        );
        tunable += usize::from(in_flight);
    }
    assert!(tunable > 25);
    let mut settings = Settings::default();
    settings.configuration.preset = AirframePreset::Iris;
    settings.configuration.airframe.mass_kg = 1.7;
    let read = QuadrotorPlant::as_read(&settings);
    assert_eq!(read.configuration.preset, AirframePreset::Iris);
    assert_eq!(read.configuration.airframe.mass_kg, 1.7);
    assert_eq!(
        read.configuration.airframe.rotor_time_constant_s,
        AirframePreset::Iris.airframe().rotor_time_constant_s
    );
    QuadrotorPlant::new(&settings, &Commands::default()).unwrap();
}

/// A point at which the model's equations are looked at, in a mode, and its states then.
fn at(settings: &Settings, numbers: &[f64; 18], commands: &Commands) -> (QuadrotorPlant, [f64; 18]) {
    let mut model = QuadrotorPlant::new(settings, commands).unwrap();
    equations().set_states(&mut model, numbers);
    equations().update(&mut model, commands);
    let mut states = [0.0; 18];
    equations().states(&model, &mut states);
    (model, states)
}

/// Clear of the ground, whose kinks differences would cross, and within the effect that it has on rotors.
fn points() -> impl Strategy<Value = [f64; 18]> {
    prop::array::uniform18(-1.0..1.0_f64).prop_map(|unit| {
        let centre = [
            0.0, 0.0, -0.8, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 250.0, 250.0, 250.0, 250.0, 0.4,
        ];
        let half =
            [3.0, 3.0, 0.4, 2.0, 2.0, 2.0, 0.1, 0.3, 0.3, 0.3, 1.0, 1.0, 1.0, 50.0, 50.0, 50.0, 50.0, 0.2];
        std::array::from_fn(|i| centre[i] + half[i] * unit[i])
    })
}

fn pushed(push: [f64; 9]) -> Commands {
    let [force, torque, wind] = [0, 3, 6].map(|from| Vector3::from_column_slice(&push[from..from + 3]));
    let disturbance = Disturbance { force_n: force, torque_n_m: torque * 0.1, wind_m_s: wind * 5.0 };
    Commands { disturbance, ..Commands::default() }
}

/// Slope at zero by central differences, extrapolated once.
fn slope(g: impl Fn(f64) -> Vec<f64>) -> Vec<f64> {
    let central = |h: f64| -> Vec<f64> {
        g(h).iter().zip(g(-h)).map(|(ahead, behind)| (ahead - behind) / (2.0 * h)).collect()
    };
    central(2e-3).iter().zip(central(1e-3)).map(|(coarse, fine)| fine + (fine - coarse) / 3.0).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// Along each state and each input, of all outputs and derivatives; and what is not declared as a dependency does not matter.
    #[test]
    fn directional_derivatives_are_those_of_differences(
        numbers in points(), push in prop::array::uniform9(-1.0..1.0), by_rotors in any::<bool>(),
    ) {
        let drive = if by_rotors { Drive::RotorSpeeds } else { Drive::Wrench };
        let (settings, commands) = (settings(one_lag(), drive), pushed(push));
        let (model, numbers) = at(&settings, &numbers, &commands);
        let unknowns = unknowns::<QuadrotorPlant>();
        let zero = || Commands {
            rotor_rad_s: [0.0; 4],
            wrench: Wrench::default(),
            disturbance: Disturbance::default(),
            ground_z_m: 0.0,
            ..commands
        };
        let mut directions: Vec<(&str, Seed<QuadrotorPlant>)> = Vec::new();
        for (index, name) in states().into_iter().enumerate() {
            let states = (0..18).map(|other| f64::from(u8::from(other == index))).collect();
            directions.push((name, Seed { states, inputs: zero() }));
        }
        for (name, set) in inputs() {
            let mut inputs = zero();
            set(&mut inputs, 1.0);
            directions.push((name, Seed { states: vec![0.0; 18], inputs }));
        }
        for (known, seed) in directions {
            let found = read(&equations().tangent(&model, &commands, &seed));
            // In the mode of the point, whatever lies beyond its bounds.
            let expected = slope(|h| {
                let mut moved = QuadrotorPlant::from_state(&settings, &model.state()).unwrap();
                let states: Vec<f64> = numbers.iter().zip(&seed.states).map(|(x, dx)| x + h * dx).collect();
                equations().set_states(&mut moved, &states);
                let add = |vector: Vector3<f64>, change: Vector3<f64>| vector + h * change;
                let (c, d) = (commands.disturbance, seed.inputs.disturbance);
                let inputs = Commands {
                    rotor_rad_s: std::array::from_fn(|i| commands.rotor_rad_s[i] + h * seed.inputs.rotor_rad_s[i]),
                    wrench: Wrench {
                        thrust_n: commands.wrench.thrust_n + h * seed.inputs.wrench.thrust_n,
                        torque_n_m: add(commands.wrench.torque_n_m, seed.inputs.wrench.torque_n_m),
                    },
                    disturbance: Disturbance {
                        force_n: add(c.force_n, d.force_n),
                        torque_n_m: add(c.torque_n_m, d.torque_n_m),
                        wind_m_s: add(c.wind_m_s, d.wind_m_s),
                    },
                    ground_z_m: commands.ground_z_m + h * seed.inputs.ground_z_m,
                    ..commands
                };
                read(&equations().outputs(&moved, &inputs))
            });
            for (((unknown, _), found), expected) in unknowns.iter().zip(&found).zip(&expected) {
                let error = (found - expected).abs();
                prop_assert!(error < 1e-6 * (1.0 + expected.abs()), "d {unknown} / d {known}: {found}, {expected}");
                let declared = equations().dependencies(unknown);
                let depends = declared.iter().any(|beginning| known.starts_with(beginning));
                prop_assert!(depends || *found == 0.0, "{unknown} depends on {known}");
            }
        }
    }

    /// The time derivatives of the outputs are their slopes along the motion.
    #[test]
    fn rates_are_slopes_along_the_motion(numbers in points(), push in prop::array::uniform9(-1.0..1.0)) {
        let (settings, commands) = (settings(one_lag(), Drive::RotorSpeeds), pushed(push));
        let (model, numbers) = at(&settings, &numbers, &commands);
        let mut motion = [0.0; 18];
        equations().derivatives(&model, &commands, &mut motion);
        let rates = read(&QuadrotorPlant::OUTPUT_RATES.unwrap()(&model));
        let expected = slope(|h| {
            let mut moved = QuadrotorPlant::from_state(&settings, &model.state()).unwrap();
            let h = 0.1 * h;
            let states: Vec<f64> = numbers.iter().zip(&motion).map(|(x, dx)| x + h * dx).collect();
            equations().set_states(&mut moved, &states);
            read(&equations().outputs(&moved, &commands))
        });
        for (((name, _), rate), expected) in unknowns::<QuadrotorPlant>().iter().zip(&rates).zip(&expected) {
            let expected = expected / 0.1;
            // The quaternion of a step's end is unit, that of a solver is what it is.
            if !name.starts_with("attitude.q") {
                prop_assert!((rate - expected).abs() < 1e-5 * (1.0 + expected.abs()), "{name}: {rate}, {expected}");
            }
        }
    }
}

/// One step of the classical Runge-Kutta method with the model's own numbers.
fn step(model: &mut QuadrotorPlant, commands: &Commands, h: f64) {
    let mut x = [0.0; 18];
    equations().states(model, &mut x);
    let mut slope = |share: f64, k: &[f64; 18]| {
        let moved: Vec<f64> = x.iter().zip(k).map(|(x, k)| x + share * h * k).collect();
        equations().set_states(model, &moved);
        let mut derivatives = [0.0; 18];
        equations().derivatives(model, commands, &mut derivatives);
        derivatives
    };
    let k1 = slope(0.0, &[0.0; 18]);
    let k2 = slope(0.5, &k1);
    let k3 = slope(0.5, &k2);
    let k4 = slope(1.0, &k3);
    let next: Vec<f64> =
        (0..18).map(|i| x[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i])).collect();
    equations().set_states(model, &next);
}

/// An importer's solver and its events against co-simulation: a drop that slides and is held at last.
#[test]
fn model_exchange_flies_as_co_simulation_does() {
    let mut settings = settings(all_physics(), Drive::RotorSpeeds);
    settings.hovering = false;
    settings.configuration.initial.position_m = [0.0, 0.0, -0.3];
    settings.configuration.initial.velocity_m_s = [0.8, -0.3, 0.0];
    let commands = Commands { rotor_rad_s: [0.0; 4], ..Commands::default() };
    let mut stepped = QuadrotorPlant::new(&settings, &commands).unwrap();
    stepped.advance_to(1_500_000, &|_| commands).unwrap();

    let mut exchanged = QuadrotorPlant::new(&settings, &commands).unwrap();
    equations().update(&mut exchanged, &commands);
    let signs = |model: &QuadrotorPlant| -> Vec<bool> {
        let mut indicators = vec![0.0; equations().event_indicators()];
        equations().indicators(model, &commands, &mut indicators);
        indicators.into_iter().map(|indicator| indicator > 0.0).collect()
    };
    let (mut before, mut events, mut jumps) = (signs(&exchanged), 0, 0);
    for _ in 0..150_000 {
        step(&mut exchanged, &commands, 1e-5);
        assert!(!equations().needs_event(&exchanged));
        if signs(&exchanged) != before {
            jumps += usize::from(equations().update(&mut exchanged, &commands));
            events += 1;
            before = signs(&exchanged);
        }
    }
    assert!((5..40).contains(&events) && (1..4).contains(&jumps), "{events} events, {jumps} with a jump");
    let (one, other) = (read(&equations().outputs(&exchanged, &commands)), read(&stepped.outputs()));
    for (((name, _), one), other) in unknowns::<QuadrotorPlant>().iter().zip(one).zip(other) {
        assert!((one - other).abs() < 2e-3, "{name}: {one}, {other}");
    }
    assert_eq!(value(&stepped, "velocity.x"), 0.0);
}

/// A solver may let the length of the quaternion drift; at an event it is one again.
#[test]
fn an_event_makes_the_quaternion_unit() {
    let (settings, commands) = (Settings::default(), Commands::default());
    let mut numbers = PlantState::from_array([0.0; 18]).to_array();
    numbers[13..17].fill(250.0);
    for (length, asks, jumps) in
        [(1.0, false, false), (1.0001, false, false), (1.1, false, true), (1.5, true, true)]
    {
        let mut model = QuadrotorPlant::new(&settings, &commands).unwrap();
        equations().update(&mut model, &commands);
        numbers[6] = length;
        equations().set_states(&mut model, &numbers);
        assert_eq!(equations().needs_event(&model), asks, "{length}");
        assert_eq!(equations().update(&mut model, &commands), jumps, "{length}");
        let expected = if jumps { 1.0 } else { length };
        let mut states = [0.0; 18];
        equations().states(&model, &mut states);
        assert_eq!(states[6], expected);
    }
}
