//! Flying by an estimate from outside.

use nalgebra::Vector3;
use quadrotor::{Configuration, Inputs, PositionReference, RigidBody, Simulation, SimulationError};

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
