//! Changes in flight of what the controllers are made of and of the vehicle itself: each such parameter is changed, and the flight
//! compared with the unchanged one.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use quadrotor::{
    Access, Configuration, ConfigurationError, ControllerKind, InputSignal, Inputs, Mutability, PARAMETERS,
    Parameter, PositionReference, RotorFault, Simulation, Wrench, wrench_of_rotors,
};

use crate::common::{KINDS, goal};

/// When parameters change, µs: between two samples of every controller, and between two events.
const CHANGE_US: u64 = 10_003_400;
const END_US: u64 = 12_500_000;
/// Long enough for a sample of each controller, µs, and for its command to be reached.
const FIRST_COMMANDS_US: u64 = 200_000;

fn base(kind: ControllerKind) -> Configuration {
    let mut configuration = Configuration::default();
    configuration.controllers.kind = kind;
    // What a design believes in is what flies.
    configuration.controllers.learning = false;
    configuration.airframe.drag_n_s_m = [0.1; 3];
    configuration.limits.speed_horizontal_m_s = 5.0;
    configuration
}

/// Under steady forces, so that each integral action has something to hold.
fn disturbed(mut inputs: Inputs) -> Inputs {
    inputs.disturbance.force_n = Vector3::new(0.3, -0.2, 0.4);
    inputs.disturbance.torque_n_m = Vector3::new(0.01, -0.02, 0.005);
    inputs
}

fn hover(_time_us: u64) -> Inputs {
    disturbed(goal([0.0, 0.0, -5.0], 0.0))
}

/// North at the speed limit, 5 m/s.
fn cruise(_time_us: u64) -> Inputs {
    disturbed(goal([200.0, 0.0, -5.0], 0.0))
}

/// A circle of 10 m at 4 m/s, nose ahead, which leans by 0.16 rad and turns by 0.4 rad/s: below the speed limit, so that it can be
/// caught up with.
fn circle(time_us: u64) -> Inputs {
    const RADIUS_M: f64 = 10.0;
    const RATE: f64 = 0.4;
    let angle = RATE * time_us as f64 * 1e-6;
    let towards = Vector3::new(angle.cos(), angle.sin(), 0.0);
    let along = Vector3::new(-angle.sin(), angle.cos(), 0.0);
    let reference = PositionReference {
        position_m: towards * RADIUS_M - Vector3::new(RADIUS_M, 0.0, 5.0),
        velocity_m_s: along * (RADIUS_M * RATE),
        acceleration_m_s2: towards * (-RADIUS_M * RATE * RATE),
        yaw_rad: angle + TAU / 4.0,
        yaw_rate_rad_s: RATE,
        ..PositionReference::goal([0.0; 3], 0.0)
    };
    disturbed(Inputs { reference, ..Inputs::default() })
}

/// A flight that is about to be changed, and how it goes on unchanged, a millisecond at a time.
struct Unchanged {
    start: Simulation,
    rest: Vec<(Vector3<f64>, Wrench)>,
}

fn commanded(simulation: &Simulation) -> Wrench {
    wrench_of_rotors(&simulation.configuration().airframe, &simulation.rotor_command_rad_s())
}

fn times_us() -> impl Iterator<Item = u64> {
    (CHANGE_US / 1_000 + 1..=END_US / 1_000).map(|millisecond| millisecond * 1_000)
}

/// Flies on and shows position and commands each millisecond.
fn fly_on(simulation: &mut Simulation, inputs: &impl InputSignal, mut see: impl FnMut(Vector3<f64>, Wrench)) {
    for time_us in times_us() {
        simulation.advance_to(time_us, inputs).unwrap();
        see(simulation.outputs().position_m, commanded(simulation));
    }
}

impl Unchanged {
    fn fly(configuration: &Configuration, inputs: &impl InputSignal) -> Self {
        let mut simulation = Simulation::new(configuration, &inputs.at(0)).unwrap();
        simulation.advance_to(CHANGE_US, inputs).unwrap();
        let start = simulation.clone();
        let mut rest = Vec::new();
        fly_on(&mut simulation, inputs, |position, command| rest.push((position, command)));
        Self { start, rest }
    }

    /// How far the flight with another configuration is from this one.
    fn compare(&self, after: &Configuration, inputs: &impl InputSignal) -> Bump {
        let mut changed = self.start.clone();
        changed.reconfigure(after).unwrap();
        let mut bump = Bump::default();
        let mut rest = self.rest.iter().zip(times_us());
        fly_on(&mut changed, inputs, |position_m, command| {
            let ((unchanged_m, unchanged), time_us) = rest.next().unwrap();
            bump.deviation_m = bump.deviation_m.max((position_m - unchanged_m).norm());
            if time_us <= CHANGE_US + FIRST_COMMANDS_US {
                bump.thrust_n = bump.thrust_n.max((command.thrust_n - unchanged.thrust_n).abs());
                bump.torque_n_m = bump.torque_n_m.max((command.torque_n_m - unchanged.torque_n_m).norm());
            }
        });
        bump
    }
}

/// Largest differences from the unchanged flight: of the position, and of what was commanded first.
#[derive(Debug, Default, Clone, Copy)]
struct Bump {
    deviation_m: f64,
    thrust_n: f64,
    torque_n_m: f64,
}

/// A value of what a vehicle has none of by default: in cruise, about a tenth of a newton.
fn small(name: &str) -> f64 {
    match name {
        "airframe.rotor.inertia" => 2e-5,
        "airframe.rotor.drag_coefficient" | "airframe.rotor.inflow_coefficient" => 2e-5,
        "airframe.rotor.lift_coefficient" => 1e-3,
        _ if name.starts_with("airframe.body_drag.") => 0.02,
        _ if name.starts_with("airframe.inertia.") => 2e-3,
        _ if name.starts_with("airframe.centre_of_gravity.") => 0.003,
        _ => 0.5,
    }
}

/// Values to change a parameter to: on both sides of the present one where there are two.
fn values(parameter: &Parameter, configuration: &Configuration) -> Vec<Configuration> {
    let mut results = Vec::new();
    let mut with = |change: &dyn Fn(&mut Configuration)| {
        let mut changed = *configuration;
        change(&mut changed);
        if changed != *configuration {
            results.push(changed);
        }
    };
    match parameter.access {
        Access::Real { minimum, maximum, get, set } => {
            let present = get(configuration);
            let factors = match parameter.name.rsplit('.').next() {
                Some("sample_time") => [0.5, 2.0],
                // Less of it asks for more than the rotors' lag leaves.
                Some("lambda") => [0.97, 1.0],
                _ => [0.8, 1.25],
            };
            if present == 0.0 {
                with(&|changed| set(changed, small(parameter.name)));
            }
            for factor in factors {
                with(&|changed| set(changed, (present * factor).clamp(minimum, maximum)));
            }
        }
        Access::Integer { minimum, maximum, get, set } => {
            let present = get(configuration);
            for value in [present - 2, present + 5] {
                with(&|changed| set(changed, value.clamp(minimum, maximum)));
            }
        }
        Access::Enumeration { choice, set, .. } => {
            for (value, _) in (1..).zip(choice.items) {
                with(&|changed| set(changed, value));
            }
        }
        Access::Boolean { get, set } => with(&|changed| set(changed, !get(configuration))),
    }
    results
}

fn structural() -> impl Iterator<Item = &'static Parameter> {
    PARAMETERS.iter().filter(|parameter| parameter.mutability == Mutability::Structural)
}

/// What the change of a vehicle does to its flight is physics, whoever controls it.
fn is_physical(parameter: &Parameter) -> bool {
    parameter.name.starts_with("airframe.")
}

/// Each kind of controllers, on all measurements and on positions and attitudes alone.
fn starts(shaping: bool) -> impl Iterator<Item = Configuration> {
    KINDS.into_iter().flat_map(move |kind| {
        [false, true].map(|output_feedback| {
            let mut configuration = base(kind);
            configuration.reference.shaping = shaping;
            configuration.sensors.output_feedback = output_feedback;
            configuration
        })
    })
}

/// In steady flight nothing shows that the controllers are others, and another vehicle is back on its way within centimetres: a
/// fifth of the mass is gone in an instant, the thrust for it only with the rotors' lag.
#[test]
fn steady_flight_goes_on_through_every_change() {
    for configuration in starts(true) {
        for (name, inputs) in [("hover", hover as fn(u64) -> Inputs), ("cruise", cruise)] {
            let unchanged = Unchanged::fly(&configuration, &inputs);
            for parameter in structural() {
                for after in values(parameter, &configuration) {
                    let bump = unchanged.compare(&after, &inputs);
                    let told = || format!("{} in {name}, {:?}: {bump:?}", parameter.name, after.controllers);
                    if is_physical(parameter) {
                        assert!(bump.deviation_m < 0.04 && bump.torque_n_m < 0.15, "{}", told());
                    } else if parameter.name == "controller.mass_factor" {
                        // A cruise at the speed limit goes by a plan, and another mass is another plan.
                        assert!(bump.deviation_m < 0.025 && bump.torque_n_m < 0.15, "{}", told());
                    } else {
                        assert!(bump.deviation_m < 0.002, "{}", told());
                        assert!(bump.thrust_n < 0.01 && bump.torque_n_m < 0.01, "{}", told());
                    }
                }
            }
        }
    }
}

/// In a circle each law has its own tracking error. The flight goes from that of one law to that of the other and no farther.
#[test]
fn a_turning_flight_goes_over_into_that_of_the_new_design() {
    for configuration in starts(false).filter(|start| start.sensors.output_feedback) {
        let unchanged = Unchanged::fly(&configuration, &circle);
        for parameter in structural().filter(|parameter| !is_physical(parameter)) {
            for after in values(parameter, &configuration) {
                let bump = unchanged.compare(&after, &circle);
                let settled = Unchanged::fly(&after, &circle);
                let both = unchanged.rest.iter().zip(&settled.rest);
                let apart_m = both.map(|((one, _), (other, _))| (one - other).norm()).fold(0.0, f64::max);
                let told = format!("{}, {:?}: {bump:?} {apart_m} m", parameter.name, after.controllers);
                assert!(bump.deviation_m < apart_m + 0.01, "{told}");
                assert!(bump.thrust_n < 0.02 && bump.torque_n_m < 0.25, "{told}");
            }
        }
    }
}

/// Every number of the controllers at once, and back again.
#[test]
fn all_controllers_can_be_replaced_at_once() {
    for kind in KINDS {
        let configuration = base(kind);
        let mut other = base(KINDS[(kind as usize + 1) % 3]);
        let controllers = &mut other.controllers;
        controllers.mass_factor = 0.9;
        (controllers.position.sample_time_us, controllers.altitude.sample_time_us) = (33_333, 41_001);
        controllers.attitude.sample_time_us = 7_003;
        (controllers.position.terms, controllers.altitude.terms, controllers.attitude.terms) = (9, 4, 6);
        controllers.attitude.scale = 0.8;
        other.sensors.output_feedback = true;

        let unchanged = Unchanged::fly(&configuration, &cruise);
        let mut changed = unchanged.start.clone();
        let mut rest = unchanged.rest.iter();
        let mut count = 0;
        changed.reconfigure(&other).unwrap();
        for time_us in times_us() {
            count += 1;
            if count % 500 == 0 {
                let next = if count % 1_000 == 0 { &other } else { &configuration };
                changed.reconfigure(next).unwrap();
            }
            changed.advance_to(time_us, &cruise).unwrap();
            let (position_m, _) = rest.next().unwrap();
            let apart_m = (changed.outputs().position_m - position_m).norm();
            assert!(apart_m < 0.01, "{kind:?} after {count} ms: {apart_m} m");
        }
    }
}

/// A change belongs to an instant: it does not matter where the caller stops before and after it, nor whether the flight is saved
/// and goes on elsewhere.
#[test]
fn a_changed_flight_is_the_same_however_it_is_split_and_saved() {
    for (kind, sample_time_us) in [(1, 10_000), (2, 7_003), (0, 3_000), (1, 14_500)] {
        let before = starts(false).nth(kind).unwrap();
        let mut after = starts(false).nth((kind + 3) % 6).unwrap();
        after.controllers.attitude.sample_time_us = sample_time_us;
        after.controllers.altitude.sample_time_us = 33_333;
        after.airframe.mass_kg = 0.6;
        let change = |split_us: u64| {
            let mut flight = Simulation::new(&before, &circle(0)).unwrap();
            let fly = |flight: &mut Simulation, to_us: u64| {
                let from_us = flight.time_us();
                let stops = (1..).map(|stop| stop * split_us).take_while(|stop| *stop < to_us);
                for time_us in stops.skip_while(|stop| *stop < from_us).chain([to_us]) {
                    flight.advance_to(time_us, &circle).unwrap();
                }
            };
            fly(&mut flight, 1_003_400);
            let at_change = flight.outputs();
            flight.reconfigure(&after).unwrap();
            // The motion is continuous.
            let now = flight.outputs();
            assert_eq!((at_change.position_m, at_change.velocity_m_s), (now.position_m, now.velocity_m_s));
            assert_eq!(at_change.rotor_speed_rad_s, now.rotor_speed_rad_s);
            let saved = postcard::to_allocvec(&flight.state()).unwrap();
            fly(&mut flight, 2_000_000);
            let mut resumed = Simulation::from_state(&after, postcard::from_bytes(&saved).unwrap()).unwrap();
            fly(&mut resumed, 2_000_000);
            assert_eq!(resumed.state(), flight.state());
            flight.state()
        };
        let whole = change(10_000_000);
        assert_eq!(change(777), whole);
        assert_eq!(change(1_000), whole);
    }
}

/// The same loop, whether its controllers are designed in place or beside it and handed over later.
#[test]
fn a_prepared_design_is_the_one_of_its_configuration() {
    let (before, after) = (base(ControllerKind::Lmpc), base(ControllerKind::StateSpaceMpc));
    let mut at_once = Simulation::new(&before, &hover(0)).unwrap().control().clone();
    let mut later = at_once.clone();
    let prepared = later.prepare(&after).unwrap();
    assert_eq!(later, at_once);
    at_once.reconfigure(&after).unwrap();
    later.hand_over(prepared);
    assert_eq!(later, at_once);
    assert_eq!(*later.configuration(), after);
}

/// The law for a lost rotor depends on airframe and sample time, too.
#[test]
fn a_flight_without_a_rotor_goes_on_through_changes() {
    let mut configuration = base(ControllerKind::Lmpc);
    configuration.airframe.drag_n_s_m = [0.0; 3];
    let mut inputs = goal([0.0, 0.0, -50.0], 0.0);
    configuration.initial.position_m = [0.0, 0.0, -50.0];
    inputs.rotor_faults[2] = Some(RotorFault::Off);
    inputs.lost_rotor = Some(2);
    let mut flight = Simulation::new(&configuration, &inputs).unwrap();
    flight.advance_to(10_000_000, &inputs).unwrap();
    configuration.controllers.attitude.sample_time_us = 5_000;
    configuration.airframe.mass_kg = 0.63;
    flight.reconfigure(&configuration).unwrap();
    flight.advance_to(20_000_000, &inputs).unwrap();
    assert!(flight.outputs().tracking_error_m.norm() < 2.0, "{:?}", flight.outputs().tracking_error_m);
    // With the law of the airframe that it has now.
    let fresh = Simulation::from_state(&configuration, flight.state()).unwrap();
    assert_eq!(fresh, flight);
}

/// Only what describes the start waits for the next one.
#[test]
fn what_describes_the_start_is_refused_in_flight() {
    let before = Configuration::default();
    let mut flight = Simulation::new(&before, &hover(0)).unwrap();
    let unchanged = flight.clone();
    let mut refused = Vec::new();
    for parameter in PARAMETERS {
        for after in values(parameter, &before) {
            if let Err(error @ ConfigurationError::Fixed { name }) = flight.reconfigure(&after) {
                assert_eq!(name, parameter.name);
                let text =
                    format!("{name} is fixed for the whole flight: a change takes effect at the next start");
                assert_eq!(error.to_string(), text);
                assert_eq!(flight, unchanged);
                refused.push(name);
            }
            flight = unchanged.clone();
        }
    }
    refused.dedup();
    let names = PARAMETERS.iter().map(|parameter| parameter.name);
    let of_the_start = ["airframe.preset", "environment.", "initial.", "reference."];
    let expected: Vec<_> =
        names.filter(|name| of_the_start.iter().any(|start| name.starts_with(start))).collect();
    assert_eq!(refused, expected);
}
