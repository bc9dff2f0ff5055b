//! The direct entry to the attitude controller, and switching the shaper in flight.

use nalgebra::{UnitQuaternion, Vector3};
use quadrotor::{
    AttitudeTarget, Configuration, GRAVITY_M_S2, Inputs, PositionReference, Simulation, SimulationError,
};

fn hovering() -> (Simulation, Inputs) {
    let mut configuration = Configuration::default();
    configuration.initial.position_m = [0.0, 0.0, -20.0];
    let inputs = Inputs { reference: PositionReference::goal([0.0, 0.0, -20.0], 0.0), ..Inputs::default() };
    let mut flight = Simulation::new(&configuration, &inputs).expect("defaults are valid");
    flight.advance_to(1_000_000, &inputs).expect("hover");
    (flight, inputs)
}

/// A lean of 0.1 rad to the right under a thrust that carries the weight: ÿ = g tan φ after the attitude has settled.
#[test]
fn a_lean_accelerates_as_its_thrust_axis_points() {
    let (mut flight, mut inputs) = hovering();
    let airframe = flight.configuration().airframe;
    let target = AttitudeTarget {
        attitude: UnitQuaternion::from_euler_angles(0.1, 0.0, 0.5),
        body_rate_rad_s: Vector3::zeros(),
        thrust_n: airframe.weight_n() / libm::cos(0.1),
    };
    inputs.attitude_target = Some(target);
    flight.advance_to(9_000_000, &inputs).expect("flight");
    let outputs = flight.outputs();
    assert!((outputs.attitude_rad - Vector3::new(0.1, 0.0, 0.5)).norm() < 0.01, "{}", outputs.attitude_rad);
    let expected = GRAVITY_M_S2 * libm::tan(0.1);
    assert!((outputs.acceleration_m_s2.xy().norm() - expected).abs() < 0.05, "{}", outputs.acceleration_m_s2);
    assert!(outputs.acceleration_m_s2.z.abs() < 0.05, "{}", outputs.acceleration_m_s2);

    // The position controller takes over where the vehicle is and brings it back.
    inputs.attitude_target = None;
    flight.advance_to(60_000_000, &inputs).expect("flight");
    assert!((flight.outputs().position_m - inputs.reference.position_m).norm() < 0.02);
}

#[test]
fn a_target_that_is_not_finite_is_refused() {
    let (mut flight, inputs) = hovering();
    let before = flight.clone();
    let target = AttitudeTarget {
        attitude: UnitQuaternion::identity(),
        body_rate_rad_s: Vector3::zeros(),
        thrust_n: f64::NAN,
    };
    let refused = flight.advance_to(2_000_000, &Inputs { attitude_target: Some(target), ..inputs });
    let name = "attitude_target";
    assert_eq!(refused, Err(SimulationError::InputNotFinite { name, time_us: 1_000_000 }));
    assert_eq!(flight, before);
}

/// The reference neither jumps nor changes its velocity when the shaper is switched off and on again on the way.
#[test]
fn the_reference_goes_on_when_the_shaper_is_switched() {
    let (mut flight, mut inputs) = hovering();
    inputs.reference = PositionReference::goal([20.0, 0.0, -20.0], 0.0);
    // Between two samples of the controllers.
    flight.advance_to(4_001_000, &inputs).expect("flight");
    for (shaping, time_us) in [(false, 4_001_001), (true, 4_002_001)] {
        let mut unswitched = flight.clone();
        unswitched.advance_to(time_us, &inputs).expect("flight");
        let before = unswitched.outputs().setpoint;
        assert!(before.velocity_m_s.x > 1.0, "{before:?}");
        inputs.shaping = Some(shaping);
        flight.advance_to(time_us, &inputs).expect("flight");
        let after = flight.outputs().setpoint;
        assert!((after.position_m - before.position_m).norm() < 1e-9, "{after:?}");
        assert!((after.velocity_m_s - before.velocity_m_s).norm() < 1e-9, "{after:?}");
    }
    flight.advance_to(20_000_000, &inputs).expect("flight");
    let outputs = flight.outputs();
    assert!((outputs.position_m - inputs.reference.position_m).norm() < 0.02, "{}", outputs.position_m);
    assert!(outputs.velocity_m_s.norm() < 0.02);
}
