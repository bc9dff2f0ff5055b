//! The controllers without a vehicle, against the closed loop and against the control loop that they run.

use fmi::Model;
use fmu::{
    AttitudeMeasurement, Controller, ControllerError, ControllerInputs, ControllerParameters, MeasuredMotion,
    Measurements, RotorSpeedMeasurement,
};
use nalgebra::{UnitQuaternion, Vector3};
use quadrotor::{
    Configuration, ControlInputs, ControlLoop, Inputs, Measurement, PARAMETERS, PositionReference,
    Simulation, Target,
};

use crate::master::{EXACT, Order, Pair, exact, measured, with_measured};

/// Both in the same state, bit for bit.
fn assert_same(pair: &Pair, flight: &Simulation) {
    let (commands, closed, body) = (pair.controller.outputs(), flight.outputs(), &pair.state.body);
    let time_us = pair.controller.time_us();
    assert_eq!(closed.time_us, time_us);
    assert_eq!(
        (closed.position_m, closed.velocity_m_s),
        (body.position_m, body.velocity_m_s),
        "{time_us} us"
    );
    assert_eq!(closed.body_rate_rad_s, body.body_rate_rad_s, "{time_us} us");
    let q = &body.attitude;
    assert_eq!(closed.quaternion, [q.w, q.i, q.j, q.k], "{time_us} us");
    assert_eq!(closed.rotor_speed_rad_s, pair.state.rotor_speed_rad_s, "{time_us} us");
    assert_eq!(flight.rotor_command_rad_s(), commands.rotor_command_rad_s, "{time_us} us");
    assert_eq!(flight.control().state().commanded_wrench(), commands.wrench, "{time_us} us");
    assert_eq!(closed.setpoint, commands.setpoint, "{time_us} us");
    assert_eq!(closed.tilt_reference_rad, commands.tilt_reference_rad, "{time_us} us");
    assert_eq!(closed.activity, commands.activity, "{time_us} us");
}

/// The default experiment, in steps of the plant's grid and in the longest ones whose multiples contain all samples.
#[test]
fn controllers_before_their_plant_are_the_closed_loop() {
    let (configuration, inputs) = (Configuration::default(), Inputs::default());
    for (step_us, end_us) in [(1_000, 20_000_000), (5_000, 6_000_000), (10_000, 20_000_000)] {
        let mut flight = Simulation::new(&configuration, &inputs).unwrap();
        let mut pair = Pair::new(&exact(configuration), &inputs, Order::GaussSeidel);
        assert_same(&pair, &flight);
        for time_us in (step_us..=end_us).step_by(usize::try_from(step_us).unwrap()) {
            pair.step(step_us, &inputs);
            flight.advance_to(time_us, &inputs).unwrap();
            assert_same(&pair, &flight);
        }
        let goal = inputs.reference.position_m;
        assert!(end_us < 20_000_000 || (pair.state.body.position_m - goal).norm() < 0.01);
    }
}

/// Gusts, a reference that moves, a landing of the rotors and a new start, and parameters that are tuned on the way; under all kinds of
/// controllers, with and without measured rates.
#[test]
fn so_they_are_in_wind_and_while_they_are_tuned() {
    for kind in 0..3 {
        let mut configuration = Configuration::default();
        configuration.controllers.kind = [
            quadrotor::ControllerKind::Lmpc,
            quadrotor::ControllerKind::StateSpaceMpc,
            quadrotor::ControllerKind::Dlqr,
        ][kind];
        configuration.sensors.output_feedback = kind == 1;
        configuration.reference.shaping = kind != 2;
        configuration.airframe.drag_n_s_m = [0.1; 3];
        configuration.initial.position_m = [1.0, -2.0, -3.0];
        configuration.initial.attitude_rad = [0.1, -0.1, 2.0];
        let at = |time_us: u64| {
            let t = time_us as f64 / 1e6;
            let mut inputs = Inputs {
                reference: PositionReference::goal([1.0 + 0.3 * t, -2.0, -4.0], 2.0),
                armed: !(4_000_000..4_020_000).contains(&time_us),
                ..Inputs::default()
            };
            inputs.disturbance.wind_m_s = Vector3::new(3.0 * (2.0 * t).sin(), 2.0, 0.5);
            inputs.disturbance.force_n.y = if t > 2.0 { 0.4 } else { 0.0 };
            inputs
        };
        let mut flight = Simulation::new(&configuration, &at(0)).unwrap();
        let mut pair = Pair::new(&exact(configuration), &at(0), Order::GaussSeidel);
        for begin_us in (0..6_000_000).step_by(1_000) {
            if begin_us == 1_503_000 {
                configuration.limits.tilt_rad = 0.4;
                configuration.limits.jerk_horizontal_m_s3 = 3.0;
                configuration.controllers.position.scale = 0.5;
                pair.controller.retune(&exact(configuration)).unwrap();
                flight.reconfigure(&configuration).unwrap();
            }
            pair.step(1_000, &at(begin_us));
            flight.advance_to(begin_us + 1_000, &|_| at(begin_us)).unwrap();
            assert_same(&pair, &flight);
        }
    }
}

/// A vehicle that sways whatever it is commanded.
fn swaying(time_us: u64) -> MeasuredMotion {
    let t = time_us as f64 * 1e-6;
    let q = UnitQuaternion::from_euler_angles(0.05 * (3.0 * t).sin(), 0.03, 0.1 * t);
    MeasuredMotion {
        position_m: [0.3 * t.sin(), -0.2 * t, 0.1 * (2.0 * t).cos()],
        velocity_m_s: [0.3 * t.cos(), -0.2, -0.2 * (2.0 * t).sin()],
        quaternion: [q.w, q.i, q.j, q.k],
        ..MeasuredMotion::default()
    }
}

fn swaying_inputs(time_us: u64) -> ControllerInputs {
    let t = time_us as f64 * 1e-6;
    let inputs = Inputs { reference: PositionReference::goal([t, 0.0, -2.0], 0.3), ..Inputs::default() };
    with_measured(&inputs, swaying(time_us))
}

/// The control loop itself, told at each of its instants what `inputs` says of it.
fn commands_of_loop(end_us: u64, inputs: impl Fn(u64) -> ControllerInputs) -> [f64; 4] {
    let control_inputs = |time_us: u64| ControlInputs::armed(Target::Reference(inputs(time_us).reference));
    let mut read = |time_us: u64| {
        let motion = inputs(time_us).measured;
        let (mut pair, body) = (crate::master::start_of(&Configuration::default(), true), motion);
        let [w, i, j, k] = body.quaternion;
        pair.body.position_m = body.position_m.into();
        pair.body.velocity_m_s = body.velocity_m_s.into();
        pair.body.attitude = nalgebra::Quaternion::new(w, i, j, k);
        pair.body.body_rate_rad_s = body.body_rate_rad_s.into();
        Measurement { motion: pair.body, rotor_speed_rad_s: body.rotor_speed_rad_s }
    };
    let mut control = ControlLoop::new(&Configuration::default(), &control_inputs(0), &mut read, 0).unwrap();
    control.advance_to(end_us - 1, &control_inputs, &mut read).unwrap()
}

/// Whatever the step, samples are taken at the instants of the control loop, of the inputs at the last communication point at or
/// before them, and of inputs that move at the instants themselves.
#[test]
fn samples_are_exact_whatever_the_communication_step() {
    const END_US: u64 = 3_000_000;
    for step_us in [1_000, 3_000, 7_500, 25_000] {
        let mut model = Controller::new(&exact(Configuration::default()), &swaying_inputs(0)).unwrap();
        for begin_us in (0..END_US).step_by(usize::try_from(step_us).unwrap()) {
            model.advance_to(begin_us + step_us, &|_| swaying_inputs(begin_us)).unwrap();
        }
        let held = commands_of_loop(END_US, |time_us| swaying_inputs(time_us / step_us * step_us));
        assert_eq!(model.outputs().rotor_command_rad_s, held, "{step_us} us");
        let moving = commands_of_loop(END_US, swaying_inputs);
        assert_eq!(held == moving, 10_000 % step_us == 0, "{step_us} us");

        let mut model = Controller::new(&exact(Configuration::default()), &swaying_inputs(0)).unwrap();
        for begin_us in (0..END_US).step_by(usize::try_from(step_us).unwrap()) {
            model.advance_to(begin_us + step_us, &swaying_inputs).unwrap();
        }
        assert_eq!(model.outputs().rotor_command_rad_s, moving, "{step_us} us, moving inputs");
    }
}

#[test]
fn a_saved_state_continues_in_this_run_and_in_another() {
    for rotor_speeds in [RotorSpeedMeasurement::Measured, RotorSpeedMeasurement::Predicted] {
        let measurements = Measurements { rotor_speeds, ..EXACT };
        let parameters = ControllerParameters { measurements, ..exact(Configuration::default()) };
        // Armed again after the state was saved, so that predicted speeds are needed.
        let at = |time_us: u64| ControllerInputs {
            armed: !(1_230_000..1_240_000).contains(&time_us),
            ..swaying_inputs(time_us)
        };
        let mut model = Controller::new(&parameters, &at(0)).unwrap();
        model.advance_to(1_234_567, &at).unwrap();
        let saved = model.state();
        model.advance_to(2_000_000, &at).unwrap();
        let expected = (model.state(), model.outputs());
        model.restore(&parameters, &saved).unwrap();
        assert_eq!(model.state(), saved);
        let other = Controller::from_state(&parameters, &saved).unwrap();
        for mut run in [model, other] {
            run.advance_to(2_000_000, &at).unwrap();
            assert_eq!((run.state(), run.outputs()), expected);
            assert!(matches!(run.advance_to(0, &at), Err(ControllerError::Backwards { .. })));
        }
    }
}

/// What initialization knows of the vehicle does not matter: it is taken over where it is at the first step.
#[test]
fn the_vehicle_is_taken_over_at_the_first_step() {
    let parameters = exact(Configuration::default());
    let mut told = Controller::new(&parameters, &swaying_inputs(0)).unwrap();
    let mut untold = Controller::new(&parameters, &ControllerInputs::default()).unwrap();
    assert_ne!(told.outputs().setpoint, untold.outputs().setpoint);
    for model in [&mut told, &mut untold] {
        model.advance_to(500_000, &swaying_inputs).unwrap();
    }
    assert_eq!((told.state(), told.outputs()), (untold.state(), untold.outputs()));
}

/// Predicted speeds are those of a plant whose rotors follow with the first-order lag; Euler angles are the same attitude but for rounding.
#[test]
fn other_measurements_make_the_same_flight() {
    let (configuration, inputs) = (Configuration::default(), Inputs::default());
    let flown = |measurements: Measurements| {
        let parameters = ControllerParameters { configuration, measurements };
        let mut pair = Pair::new(&parameters, &inputs, Order::GaussSeidel);
        for time_us in (0..8_000_000).step_by(1_000) {
            // Off and on: the rotors fall, and are taken over as they turn.
            let armed = !(3_000_000..3_050_000).contains(&time_us);
            pair.step(1_000, &Inputs { armed, ..inputs });
        }
        pair.state
    };
    let measured = flown(EXACT);
    let predicted = flown(Measurements { rotor_speeds: RotorSpeedMeasurement::Predicted, ..EXACT });
    let angles = flown(Measurements { attitude: AttitudeMeasurement::EulerAngles, ..EXACT });
    for (name, other) in [("predicted", predicted), ("angles", angles)] {
        let apart_m = (measured.body.position_m - other.body.position_m).norm();
        assert!(apart_m < 1e-6, "{name}: {apart_m} m");
    }
}

#[test]
fn what_cannot_be_measured_is_named() {
    let parameters = exact(Configuration::default());
    let angles = Measurements { attitude: AttitudeMeasurement::EulerAngles, ..EXACT };
    let by_angles = ControllerParameters { measurements: angles, ..parameters };
    let with = |change: &dyn Fn(&mut MeasuredMotion)| {
        let mut inputs = ControllerInputs::default();
        change(&mut inputs.measured);
        inputs
    };
    let none = with(&|measured| measured.quaternion = [0.0; 4]);
    let refused = Controller::new(&parameters, &none).err().unwrap().to_string();
    assert_eq!(
        refused,
        "measured.attitude.q0 to q3 = 0, 0, 0, 0 is no attitude at 0 s; allowed: a norm of 1, at least 0.5; connect the \
         attitude, or set measurement.attitude to euler_angles and connect measured.attitude.phi, theta and psi"
    );
    assert!(Controller::new(&by_angles, &none).is_ok());
    for (name, change) in [
        ("measured.position.y", &(|m: &mut MeasuredMotion| m.position_m[1] = f64::NAN) as &dyn Fn(&mut _)),
        ("measured.velocity.z", &|m: &mut MeasuredMotion| m.velocity_m_s[2] = f64::INFINITY),
        ("measured.attitude.q3", &|m: &mut MeasuredMotion| m.quaternion[3] = f64::NAN),
        ("measured.body_rate.p", &|m: &mut MeasuredMotion| m.body_rate_rad_s[0] = f64::NAN),
        ("measured.rotor.speed[4]", &|m: &mut MeasuredMotion| m.rotor_speed_rad_s[3] = f64::NAN),
        ("measured.attitude.theta", &|m: &mut MeasuredMotion| m.attitude_rad[1] = f64::NAN),
    ] {
        let parameters = if name.ends_with("theta") { &by_angles } else { &parameters };
        let mut model = Controller::new(parameters, &ControllerInputs::default()).unwrap();
        model.advance_to(20_000, &|_| ControllerInputs::default()).unwrap();
        let (before, broken) = (model.state(), with(change));
        let refused = model.advance_to(30_000, &|_| broken).unwrap_err();
        assert_eq!(refused, ControllerError::NotFinite { name, time_us: 20_000 });
        assert_eq!(model.state(), before);
        assert!(refused.to_string().starts_with(name), "{refused}");
    }
}

/// The parameters that are left out are those that the controllers do not look at.
#[test]
fn only_a_plant_knows_what_is_left_out() {
    let names: Vec<&str> =
        Controller::VARIABLES.iter().copied().flatten().map(|variable| variable.name).collect();
    let flown = |configuration: &Configuration| {
        let mut model = Controller::new(&exact(*configuration), &swaying_inputs(0)).unwrap();
        model.advance_to(1_000_000, &swaying_inputs).unwrap();
        (model.outputs(), model.warnings())
    };
    let expected = flown(&Configuration::default());
    let mut left_out = 0;
    for parameter in PARAMETERS.iter().filter(|parameter| !names.contains(&parameter.name)) {
        let mut changed = Configuration::default();
        match parameter.access {
            quadrotor::Access::Real { minimum, maximum, get, set } => {
                // A little is enough to be seen, and no airframe is refused for it.
                let value = get(&changed);
                let by = 1e-3 * if value == 0.0 { 1.0 } else { value };
                set(&mut changed, (value + by).clamp(minimum, maximum));
            }
            quadrotor::Access::Integer { set, .. } => set(&mut changed, 7),
            quadrotor::Access::Boolean { get, set } => {
                let other = !get(&changed);
                set(&mut changed, other);
            }
            quadrotor::Access::Enumeration { .. } => panic!("{} is left out", parameter.name),
        }
        assert_ne!(changed, Configuration::default(), "{}", parameter.name);
        assert_eq!(flown(&changed), expected, "{}", parameter.name);
        left_out += 1;
    }
    assert_eq!(left_out, 32);
}

#[test]
fn a_state_of_no_run_is_refused() {
    let parameters = exact(Configuration::default());
    let mut model = Controller::new(&parameters, &swaying_inputs(0)).unwrap();
    model.advance_to(1_234_567, &swaying_inputs).unwrap();
    let good = serde_json::to_value(model.state()).unwrap();
    for (place, value) in [("/time_us", 1_236_000), ("/time_us", 1_233_999), ("/rotors/time_us", 1_235_000)] {
        let mut forged = good.clone();
        *forged.pointer_mut(place).unwrap() = value.into();
        let forged = serde_json::from_value(forged).unwrap();
        assert!(
            matches!(model.restore(&parameters, &forged), Err(ControllerError::Configuration(_))),
            "{place}"
        );
        assert!(Controller::from_state(&parameters, &forged).is_err(), "{place}");
        assert_eq!(serde_json::to_value(model.state()).unwrap(), good);
    }
}

/// Ground is where the plant says; learning does not look at a vehicle on it.
#[test]
fn a_run_over_ground_begins_anywhere() {
    let mut parameters = exact(Configuration::default());
    parameters.configuration.environment.ground_plane = true;
    let mut model = Controller::new(&parameters, &ControllerInputs::default()).unwrap();
    model.advance_to(100_000, &|_| ControllerInputs::default()).unwrap();
    assert!(model.outputs().rotor_command_rad_s.iter().all(|speed| *speed > 0.0));
}

#[test]
fn measured_states_are_what_a_plant_has() {
    let state = crate::master::start_of(&Configuration::default(), true);
    assert_eq!(measured(&state), MeasuredMotion::default());
}
