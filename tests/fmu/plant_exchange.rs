//! The plant under an importer's own solver and events, through the C interface, against co-simulation.

use crate::common::instance::Instance;
use crate::common::library::{ERROR, OK};
use crate::plant;

/// Dropped from 30 cm with rotors at rest, it slides and comes to rest.
const REALS: [(&str, f64); 4] = [
    ("initial.position.z", -0.3),
    ("initial.velocity.x", 0.8),
    ("initial.velocity.y", -0.3),
    ("initial.attitude.phi", 0.05),
];
const BOOLEANS: [(&str, bool); 2] = [("environment.ground_plane", true), ("initial.hovering", false)];
const AT_REST: [(&str, f64); 4] = [
    ("rotor.command[1]", 0.0),
    ("rotor.command[2]", 0.0),
    ("rotor.command[3]", 0.0),
    ("rotor.command[4]", 0.0),
];

fn prepare(instance: &mut Instance) {
    assert_eq!(instance.set_real(&REALS), OK);
    assert_eq!(instance.set_real(&AT_REST), OK);
    assert_eq!(instance.set_boolean(&BOOLEANS), OK);
    instance.initialize();
}

/// One step of Heun's method.
fn step(instance: &mut Instance, time: f64, h: f64) {
    let x = instance.continuous_states();
    let one = instance.derivatives();
    let ahead: Vec<f64> = x.iter().zip(&one).map(|(x, slope)| x + h * slope).collect();
    assert_eq!(instance.set_time(time + h), OK);
    assert_eq!(instance.set_continuous_states(&ahead), OK);
    let other = instance.derivatives();
    let next: Vec<f64> =
        x.iter().zip(one.iter().zip(&other)).map(|(x, (one, other))| x + h / 2.0 * (one + other)).collect();
    assert_eq!(instance.set_continuous_states(&next), OK);
}

fn signs(instance: &mut Instance) -> Vec<bool> {
    instance.event_indicators().into_iter().map(|indicator| indicator > 0.0).collect()
}

#[test]
fn a_landing_is_that_of_co_simulation() {
    let mut stepped = Instance::new(plant());
    prepare(&mut stepped);
    stepped.fly(0.0, 0.01, 120);

    let mut exchanged = Instance::for_model_exchange(plant());
    prepare(&mut exchanged);
    exchanged.new_discrete_states();
    assert_eq!(exchanged.enter_continuous_time_mode(), OK);
    let mut before = signs(&mut exchanged);
    let (mut events, mut jumps) = (0, 0);
    for i in 0..24_000 {
        step(&mut exchanged, f64::from(i) * 5e-5, 5e-5);
        if signs(&mut exchanged) != before {
            assert_eq!(exchanged.enter_event_mode(), OK);
            let info = exchanged.new_discrete_states();
            assert_eq!((info.new_discrete_states_needed, info.terminate_simulation), (0, 0));
            jumps += info.values_of_continuous_states_changed;
            assert_eq!(exchanged.enter_continuous_time_mode(), OK);
            events += 1;
            before = signs(&mut exchanged);
        }
    }
    assert!((5..40).contains(&events) && jumps > 0, "{events} events, {jumps} jumps");
    let names = ["position.x", "position.y", "position.z", "velocity.x", "velocity.y", "attitude.psi"];
    let (one, other) = (exchanged.reals(names), stepped.reals(names));
    for (name, (one, other)) in names.iter().zip(one.into_iter().zip(other)) {
        assert!((one - other).abs() < 1e-3, "{name}: {one}, {other}");
    }
    // Static friction holds it exactly.
    assert_eq!(exchanged.reals(["velocity.x", "der(position.x)", "der(body_rate.r)"]), [0.0; 3]);
}

/// Of the thrust of a hovering vehicle: −2 k₁ ω/m per rotor speed, and g per 2 q₁ of roll.
#[test]
fn derivatives_are_those_found_by_hand() {
    let mut instance = Instance::for_model_exchange(plant());
    instance.initialize();
    instance.new_discrete_states();
    let mut along = |unknown: &str, known: &str| {
        instance.directional_derivative(&[unknown], &[(known, 1.0)]).expect("it exists")[0]
    };
    let close = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-12, "{found}, {expected}");
    let speed = (0.7_f64 * 9.806_65 / (4.0 * 2.7e-5)).sqrt();
    close(along("acceleration.z", "rotor.speed[2]"), -2.0 * 2.7e-5 * speed / 0.7);
    close(along("der(velocity.y)", "attitude.q1"), 2.0 * 9.806_65);
    close(along("der(rotor.speed[3])", "rotor.command[3]"), 1.0 / 0.03);
    close(along("acceleration.x", "disturbance.force.x"), 1.0 / 0.7);
    close(along("attitude.phi", "attitude.q1"), 2.0);
    close(along("altitude", "position.z"), -1.0);
    close(along("position.x", "rotor.command[1]"), 0.0);
}

/// CasADi sets states as variables. Nothing is set when one of them cannot be.
#[test]
fn states_are_variables_that_can_be_set() {
    let mut instance = Instance::for_model_exchange(plant());
    assert_eq!(instance.set_real(&[("position.x", 1.0)]), ERROR);
    instance.initialize();
    instance.new_discrete_states();
    assert_eq!(instance.enter_continuous_time_mode(), OK);
    assert_eq!(
        instance.set_real(&[("velocity.x", 3.0), ("disturbance.force.x", 0.7), ("position.y", -2.0)]),
        OK
    );
    let read = instance.reals(["velocity.x", "der(position.x)", "acceleration.x", "position.y"]);
    assert!((read[2] - 1.0).abs() < 1e-12);
    assert_eq!([read[0], read[1], read[3]], [3.0, 3.0, -2.0]);
    assert_eq!(instance.continuous_states()[..4], [0.0, -2.0, 0.0, 3.0]);
    for (name, value) in [("velocity.y", f64::NAN), ("altitude", 1.0), ("airframe.mass", 0.8)] {
        assert_eq!(instance.set_real(&[("velocity.x", 9.0), (name, value)]), ERROR, "{name}");
        assert!(instance.log.last().text.contains(name));
        assert_eq!(instance.real("velocity.x"), 3.0);
    }
    let mut stepped = Instance::initialized(plant(), &[], &[]);
    assert_eq!(stepped.set_real(&[("velocity.x", 3.0)]), ERROR);
}
