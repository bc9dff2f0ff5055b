//! Flying by an estimate from outside.

use crate::common::KINDS;
use nalgebra::Vector3;
use quadrotor::{
    Configuration, ControllerKind, Inputs, Limits, PositionReference, RigidBody, Simulation, SimulationError,
};

fn hovering() -> (Simulation, Inputs) {
    let mut configuration = Configuration::default();
    configuration.initial.position_m = [0.0, 0.0, -20.0];
    let inputs = Inputs { reference: PositionReference::goal([0.0, 0.0, -20.0], 0.0), ..Inputs::default() };
    let mut flight = Simulation::new(&configuration, &inputs).expect("defaults are valid");
    flight.advance_to(1_000_000, &inputs).expect("hover");
    (flight, inputs)
}

fn truth(flight: &Simulation) -> RigidBody {
    let outputs = flight.outputs();
    let [w, x, y, z] = outputs.quaternion;
    RigidBody {
        position_m: outputs.position_m,
        velocity_m_s: outputs.velocity_m_s,
        attitude: nalgebra::Quaternion::new(w, x, y, z),
        body_rate_rad_s: outputs.body_rate_rad_s,
    }
}

/// Controllers that believe to be a metre further north fly a metre further south.
#[test]
fn the_vehicle_goes_where_the_estimate_is_at_the_goal() {
    let (mut flight, mut inputs) = hovering();
    let off = Vector3::new(1.0, 0.0, -0.5);
    for tick in 1_000..16_000 {
        let truth = truth(&flight);
        inputs.estimate = Some(RigidBody { position_m: truth.position_m + off, ..truth });
        flight.advance_to((tick + 1) * 1_000, &inputs).expect("flight");
    }
    let goal = inputs.reference.position_m;
    assert!((flight.outputs().position_m - (goal - off)).norm() < 0.01, "{}", flight.outputs().position_m);
    // The truth again: it comes back.
    inputs.estimate = None;
    flight.advance_to(40_000_000, &inputs).expect("flight");
    assert!((flight.outputs().position_m - goal).norm() < 0.01, "{}", flight.outputs().position_m);
}

/// The truth as an estimate is the flight without one.
#[test]
fn the_truth_as_an_estimate_changes_nothing() {
    let (mut flight, mut inputs) = hovering();
    let mut plain = flight.clone();
    inputs.reference = PositionReference::goal([5.0, 5.0, -10.0], 0.5);
    for tick in 1_000..6_000 {
        let estimated = Inputs { estimate: Some(truth(&flight)), ..inputs };
        flight.advance_to((tick + 1) * 1_000, &estimated).expect("flight");
        plain.advance_to((tick + 1) * 1_000, &inputs).expect("flight");
    }
    let apart = (flight.outputs().position_m - plain.outputs().position_m).norm();
    // The attitude of the outputs has been normalised once more: rounding.
    assert!(apart < 1e-9, "{apart}");
}

#[test]
fn an_estimate_that_is_no_motion_is_refused() {
    let (mut flight, inputs) = hovering();
    let before = flight.clone();
    let right = truth(&flight);
    let nowhere = RigidBody { position_m: Vector3::new(f64::NAN, 0.0, 0.0), ..right };
    let no_attitude = RigidBody { attitude: nalgebra::Quaternion::new(0.0, 0.0, 0.0, 0.0), ..right };
    for wrong in [nowhere, no_attitude] {
        let refused = flight.advance_to(2_000_000, &Inputs { estimate: Some(wrong), ..inputs });
        let name = "estimate";
        assert_eq!(refused, Err(SimulationError::InputNotFinite { name, time_us: 1_000_000 }));
        assert_eq!(flight, before);
    }
}

/// The estimate leaps by 97 m within three seconds, and the reference with it: nothing has moved, so the vehicle flies as without,
/// whatever steers it.
#[test]
fn another_origin_changes_no_flight() {
    let rests = |_: f64| PositionReference::goal([0.0, 0.0, -20.0], 0.0);
    let goal = |_: f64| PositionReference::goal([30.0, 5.0, -25.0], 1.0);
    // What is lacking is found from many samples.
    let circle = |t: f64| PositionReference::goal([3.0 * t.sin(), 3.0 - 3.0 * t.cos(), -20.0], 0.0);
    let moving = |t: f64| PositionReference {
        velocity_m_s: Vector3::new(3.0 * t.cos(), 3.0 * t.sin(), 0.0),
        ..circle(t)
    };
    for kind in KINDS {
        for way in [&rests as &dyn Fn(f64) -> PositionReference, &goal, &circle, &moving] {
            assert_as_flown_from_another_origin(kind, Limits::default(), false, way);
        }
        assert_as_flown_from_another_origin(kind, Limits::default(), true, &goal);
        // So slow a tilt that a way to the goal is planned.
        let slow = Limits { tilt_rate_rad_s: 0.8, tilt_acceleration_rad_s2: 1.0, ..Limits::default() };
        assert_as_flown_from_another_origin(kind, slow, false, &goal);
    }
}

/// Flies for 11 s by a reference that is set each 50 ms, once as it is and once from an origin that moves meanwhile.
fn assert_as_flown_from_another_origin(
    kind: ControllerKind,
    limits: Limits,
    shaping: bool,
    way: &dyn Fn(f64) -> PositionReference,
) {
    let mut configuration = Configuration { limits, ..Configuration::default() };
    configuration.controllers.kind = kind;
    configuration.initial.position_m = [0.0, 0.0, -20.0];
    let mut inputs = Inputs { reference: way(0.0), shaping: Some(shaping), ..Inputs::default() };
    let mut flight = Simulation::new(&configuration, &inputs).expect("a valid configuration");
    let (mut plain, mut plain_inputs) = (flight.clone(), inputs);
    let mut origin_m = Vector3::zeros();
    let mut apart_m = 0.0_f64;
    for tick in 0..11_000_u64 {
        if tick % 50 == 0 {
            plain_inputs.reference = way(tick as f64 * 1e-3);
            inputs.reference = plain_inputs.reference;
            inputs.reference.position_m += origin_m;
        }
        if (1_000..4_000).contains(&tick) {
            // Sums of these are exact: rounding would be another reference.
            let by_m = Vector3::new(1.0 / 32.0, -1.0 / 128.0, 1.0 / 256.0);
            origin_m += by_m;
            inputs.reference.position_m += by_m;
            flight.shift_positions(&by_m).expect("finite");
        }
        let truth = truth(&flight);
        inputs.estimate = Some(RigidBody { position_m: truth.position_m + origin_m, ..truth });
        flight.advance_to((tick + 1) * 1_000, &inputs).expect("flight");
        plain.advance_to((tick + 1) * 1_000, &plain_inputs).expect("flight");
        apart_m = apart_m.max((flight.outputs().position_m - plain.outputs().position_m).norm());
    }
    let towards = way(0.0).position_m.transpose();
    assert!(apart_m < 1e-6, "{kind:?}, shaping {shaping}, towards {towards}: {apart_m} m apart, {limits:?}");
}

#[test]
fn a_shift_out_of_the_range_of_numbers_is_refused() {
    let (mut flight, _) = hovering();
    let before = flight.clone();
    let refused = flight.shift_positions(&Vector3::new(0.0, f64::NAN, 0.0));
    assert!(matches!(refused, Err(SimulationError::InputNotFinite { name: "by_m", .. })));
    assert_eq!(flight, before);
}
