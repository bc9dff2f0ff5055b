//! The closed loop on plants with physics that its controllers do not know.

use nalgebra::Vector3;
use quadrotor::{Airframe, AirframePreset, BatteryPack, Configuration, ControllerKind, Inputs, Simulation};

use crate::common::{KINDS, distance, farthest_m, fly, goal};

/// What makes an option of an airframe without.
type Change = fn(&mut Airframe);

/// Names of the options, each with values of a vehicle of this size.
const OPTIONS: [(&str, Change); 10] = [
    ("none", |_| {}),
    ("body drag", |airframe| airframe.body_drag_n_s_m = [0.15, 0.2, 0.3]),
    ("rotor drag", |airframe| airframe.rotor_aerodynamics.drag_coefficient_n_s2_m = 2e-4),
    // 40 g with a radius of gyration of 5 cm
    ("rotor inertia", |airframe| airframe.rotor_spin.inertia_kg_m2 = 1e-4),
    ("products of inertia", |airframe| airframe.products_of_inertia_kg_m2 = [0.005, -0.0025, 0.0025]),
    ("centre of gravity", |airframe| airframe.centre_of_gravity_m = [0.01, -0.01, 0.03]),
    ("fall lag", |airframe| airframe.rotor_spin.fall_time_ratio = 2.0),
    ("inflow", |airframe| {
        airframe.rotor_aerodynamics.inflow_coefficient_n_s2_m = 3e-4;
        airframe.rotor_aerodynamics.translational_lift_coefficient_n_s2_m2 = 3e-3;
    }),
    ("ground effect", |airframe| airframe.rotor_aerodynamics.ground_effect = true),
    ("battery sag", |airframe| {
        airframe.battery =
            BatteryPack { sag: true, resistance_ohm: 0.1, capacity_a_s: 400.0, ..airframe.battery };
    }),
];

fn everything(airframe: &mut Airframe) {
    for (_, change) in OPTIONS {
        change(airframe);
    }
}

fn configuration(change: impl Fn(&mut Airframe)) -> Configuration {
    let mut configuration = Configuration::default();
    configuration.environment.ground_plane = true;
    configuration.initial.position_m = [0.0, 0.0, -1.0];
    change(&mut configuration.airframe);
    configuration
}

/// Largest excursion from a hover in 10 s, distance at the end of it; overshoot and settling time (2 cm) of 5 m north.
fn figures(configuration: &Configuration) -> [f64; 4] {
    let mut excursion: f64 = 0.0;
    let hovering = fly(configuration, &goal([0.0, 0.0, -1.0], 0.0), 10.0, |outputs| {
        excursion = excursion.max((outputs.position_m - Vector3::new(0.0, 0.0, -1.0)).norm());
    });
    let hover = (hovering.outputs().position_m - Vector3::new(0.0, 0.0, -1.0)).norm();
    let (mut overshoot, mut settled_s) = (0.0_f64, 0.0);
    fly(configuration, &goal([5.0, 0.0, -1.0], 0.0), 25.0, |outputs| {
        overshoot = overshoot.max(outputs.position_m.x / 5.0 - 1.0);
        if (outputs.position_m - Vector3::new(5.0, 0.0, -1.0)).norm() > 0.02 {
            settled_s = outputs.time_us as f64 / 1e6;
        }
    });
    [excursion, hover, overshoot, settled_s]
}

/// The controllers take each option for a disturbance and still arrive. Each one leaves its mark on the flight.
#[test]
fn each_option_can_be_flown() {
    let goal_m = [4.0, -3.0, -3.0];
    let mark = |change: Change| {
        fly(&configuration(change), &goal(goal_m, 0.5), 2.0, |_| {}).outputs().rotor_speed_rad_s
    };
    let [(_, nothing), options @ ..] = OPTIONS;
    for (name, change) in options.into_iter().chain([("everything", everything as Change)]) {
        let [excursion, hover, overshoot, settled_s] = figures(&configuration(change));
        println!("{name:20} {excursion:6.4} m {:5.2} % {settled_s:5.2} s", 100.0 * overshoot);
        assert!(excursion < 0.2 && hover < 0.02, "{name}: {excursion} {hover}");
        assert!(overshoot < 0.1 && settled_s < 12.0, "{name}: {overshoot} {settled_s}");
        assert_ne!(mark(change), mark(nothing), "{name}");
    }
}

/// An offset centre of mass takes a torque for ever, of which an angular acceleration alone would break every limit of the tilt. The
/// rotors that balance it stand for no motion: a step is as soon settled as by the regulator, whatever the size.
#[test]
fn a_balanced_weight_is_no_motion() {
    let flight = |preset: AirframePreset, share: f64, kind: ControllerKind| {
        let mut configuration = Configuration::for_airframe(&preset.airframe()).unwrap();
        configuration.controllers.kind = kind;
        configuration.reference.shaping = false;
        let airframe = &mut configuration.airframe;
        airframe.centre_of_gravity_m = [1.0, -0.7, 0.0].map(|part| part * share * airframe.arm_length_m);
        let goal_m = [2.0, 0.0, 0.0];
        let mut settled_s = 0.0;
        let end = fly(&configuration, &goal(goal_m, 0.0), 10.0, |outputs| {
            if distance(outputs, goal_m) > 0.02 {
                settled_s = outputs.time_us as f64 / 1e6;
            }
        });
        (settled_s, distance(&end.outputs(), goal_m))
    };
    for (preset, share) in [(AirframePreset::Crazyflie, 0.02), (AirframePreset::Heavy, 0.08)] {
        let (regulated_s, _) = flight(preset, share, ControllerKind::Dlqr);
        for kind in [ControllerKind::Lmpc, ControllerKind::StateSpaceMpc] {
            let (settled_s, end_m) = flight(preset, share, kind);
            assert!(end_m < 1e-3, "{preset:?}, {kind:?}: {end_m} m");
            assert!(settled_s < 1.1 * regulated_s + 0.2, "{preset:?}, {kind:?}: {settled_s} {regulated_s}");
        }
    }
}

/// A hover under way with an offset centre of mass has rotors that balance it, and the controllers know from the first sample on that
/// something holds the body against them.
#[test]
fn a_balanced_hover_begins_at_rest() {
    for preset in AirframePreset::ALL {
        for kind in KINDS {
            for output_feedback in [false, true] {
                let mut configuration = Configuration::for_airframe(&preset.airframe()).unwrap();
                configuration.controllers.kind = kind;
                configuration.sensors.output_feedback = output_feedback;
                let airframe = &mut configuration.airframe;
                airframe.centre_of_gravity_m = [0.02, -0.014, 0.0].map(|part| part * airframe.arm_length_m);
                let farthest_m = farthest_m(&configuration, &goal([0.0; 3], 0.0), 4.0);
                assert!(farthest_m < 1e-9, "{preset:?} {kind:?} {output_feedback}: {farthest_m} m");
            }
        }
    }
}

/// From the ground, with all options, back to the ground; without rotors the feet bear the offset weight.
#[test]
fn with_everything_it_takes_off_and_lands() {
    let mut configuration = configuration(everything);
    configuration.initial.position_m = [0.0; 3];
    let inputs = |time_us: u64| {
        let down = time_us > 14_000_000;
        let goal_m = if down { [2.0, 1.0, 0.3] } else { [2.0, 1.0, -2.0] };
        Inputs { armed: (1_000_000..24_000_000).contains(&time_us), ..goal(goal_m, 0.0) }
    };
    let mut stood = None;
    let mut flew = Vector3::zeros();
    let end = fly(&configuration, &inputs, 26.0, |outputs| match outputs.time_us {
        1_000_000 => stood = Some(*outputs),
        14_000_000 => flew = outputs.position_m,
        _ => {}
    });
    let (stood, landed) = (stood.expect("it was seen"), end.outputs());
    assert!(stood.position_m.norm() < 0.02 && stood.velocity_m_s.norm() < 1e-3, "{stood:?}");
    assert!((flew - Vector3::new(2.0, 1.0, -2.0)).norm() < 0.05, "{flew}");
    assert!((landed.position_m - Vector3::new(2.0, 1.0, 0.0)).norm() < 0.1, "{landed:?}");
    assert!(landed.velocity_m_s.norm() < 1e-2 && landed.attitude_rad.xy().norm() < 0.05, "{landed:?}");
}

/// The charge is part of the saved state, and a battery that is drained makes the rotors slower than commanded.
#[test]
fn a_saved_flight_goes_on_with_the_same_charge() {
    let mut configuration = configuration(everything);
    configuration.initial.discharge = 0.3;
    let inputs = goal([3.0, 0.0, -2.0], 0.0);
    let mut straight = Simulation::new(&configuration, &inputs).unwrap();
    straight.advance_to(4_000_000, &inputs).unwrap();
    let bytes = postcard::to_allocvec(&straight.state()).unwrap();
    let mut resumed = Simulation::from_state(&configuration, postcard::from_bytes(&bytes).unwrap()).unwrap();
    for flight in [&mut straight, &mut resumed] {
        flight.advance_to(8_000_000, &inputs).unwrap();
    }
    assert_eq!(straight.state(), resumed.state());
    let outputs = straight.outputs();
    assert!(outputs.battery.remaining < 0.65 && outputs.battery.remaining > 0.5, "{:?}", outputs.battery);
    let share = outputs.battery.voltage_v / configuration.airframe.battery.voltage_v;
    for (speed, command) in outputs.rotor_speed_rad_s.iter().zip(straight.rotor_command_rad_s()) {
        assert!((speed / command - share).abs() < 0.01, "{speed} of {command}");
    }
}

/// What contradicts the rest is refused with the parameter, the limit and the remedy.
#[test]
fn impossible_airframes_are_refused() {
    let refused =
        |change: Change| Simulation::new(&configuration(change), &Inputs::default()).unwrap_err().to_string();
    assert_eq!(
        refused(|airframe| airframe.products_of_inertia_kg_m2 = [0.0, 0.02, 0.0]),
        "airframe.inertia is no rigid body's: its principal moments 1.026e-1, 1.063e-1 and 2.159e-1 kg·m² must be positive, \
         and each at most the sum of the other two; reduce airframe.inertia.xy, .xz and .yz"
    );
    assert_eq!(
        refused(|airframe| airframe.rotor_spin.inertia_kg_m2 = 0.06),
        "airframe.rotor.inertia = 0.06 kg·m² must be at most 0.05305 kg·m²: airframe.inertia.z includes all four rotors"
    );
    // Half of 0.9438 N·m of pitch torque over 6.8647 N.
    assert_eq!(
        refused(|airframe| airframe.centre_of_gravity_m = [-0.08, 0.0, 0.0]),
        "airframe.centre_of_gravity.x = -0.08 m must be within ± 0.06875 m: \
         balancing more takes over half of the roll and pitch torque in hover"
    );
    assert!(
        refused(|airframe| airframe.centre_of_gravity_m = [0.03, 0.045, 0.0])
            .starts_with("airframe.centre_of_gravity.y = 0.045 m must be within ± 0.0387")
    );
    // 12.6² V² · 0.6264 · 0.3736 / 51.28 W
    let sagging = |airframe: &mut Airframe| {
        airframe.battery = BatteryPack { sag: true, resistance_ohm: 0.8, ..airframe.battery };
    };
    assert_eq!(
        refused(sagging),
        "airframe.battery.resistance = 0.8 Ohm must be at most 0.7245 Ohm: \
         with more the voltage in hover is too low to carry the vehicle; raise airframe.battery.voltage"
    );
    let ideal = |airframe: &mut Airframe| airframe.battery.resistance_ohm = 0.8;
    assert!(Simulation::new(&configuration(ideal), &Inputs::default()).is_ok());
}
