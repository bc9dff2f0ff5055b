//! Flights: the default one, and that it is the engine's, bit for bit.

use quadrotor::{
    Configuration, ControllerActivity, ControllerKind, ControllerStatus, Inputs, Outputs, Sensors, Simulation,
};

use crate::closed_loop;
use crate::common::instance::Instance;
use crate::common::library::{ERROR, OK};

/// The engine's outputs in the order of the description, by name; reals before all others.
fn bits(outputs: &Outputs) -> Vec<u64> {
    let o = outputs;
    let vector = |vector: &[f64]| vector.to_vec();
    let groups: [(&str, Vec<f64>); 18] = [
        ("position.", vector(o.position_m.as_slice())),
        ("altitude", vec![-o.position_m.z + 0.0]),
        ("velocity.", vector(o.velocity_m_s.as_slice())),
        ("acceleration.", vector(o.acceleration_m_s2.as_slice())),
        ("body_velocity.", vector(o.body_velocity_m_s.as_slice())),
        ("attitude.", [o.attitude_rad.as_slice(), &o.quaternion].concat()),
        ("body_rate.", vector(o.body_rate_rad_s.as_slice())),
        ("thrust", vec![o.thrust_n]),
        ("torque.", vector(o.torque_n_m.as_slice())),
        ("rotor.", vector(&o.rotor_speed_rad_s)),
        ("battery.", vec![o.battery.voltage_v, o.battery.current_a, o.battery.remaining]),
        ("tilt_reference.", vector(&o.tilt_reference_rad)),
        ("setpoint.position.", vector(o.setpoint.position_m.as_slice())),
        ("setpoint.velocity.", vector(o.setpoint.velocity_m_s.as_slice())),
        ("setpoint.acceleration.", vector(o.setpoint.acceleration_m_s2.as_slice())),
        ("setpoint.yaw", vec![o.setpoint.yaw_rad]),
        ("tracking_error.", vector(o.tracking_error_m.as_slice())),
        ("yaw_error", vec![o.yaw_error_rad]),
    ];
    let (mut reals, mut whole) = (Vec::new(), Vec::new());
    let outputs =
        closed_loop().description.variables.iter().filter(|variable| variable.causality == "output");
    let mut names = outputs.map(|variable| variable.name.as_str());
    for (group, values) in &groups {
        for value in values {
            let name = names.next().expect("as many outputs as the engine has");
            assert!(name.starts_with(group), "{name} is not in {group}");
            reals.push(value.to_bits());
        }
    }
    let activity = &o.activity;
    let activities =
        [("altitude", activity.altitude), ("position", activity.position), ("attitude", activity.attitude)];
    let status = |activity: &ControllerActivity| match activity.status {
        ControllerStatus::Optimal => 1,
        ControllerStatus::Relaxed => 2,
        ControllerStatus::IterationLimit => 3,
        ControllerStatus::Held => 4,
    };
    for (controller, activity) in activities {
        let figures = [
            ("status", status(&activity)),
            ("active_constraints", activity.active.into()),
            ("iterations", activity.iterations.into()),
        ];
        for (figure, value) in figures {
            assert_eq!(names.next(), Some(format!("controller.{controller}.{figure}").as_str()));
            whole.push(value);
        }
    }
    for (controller, activity) in activities {
        assert_eq!(names.next(), Some(format!("controller.{controller}.status_number").as_str()));
        whole.push(status(&activity));
    }
    let drag = ["drag.x", "drag.y", "drag.z"].into_iter().zip(o.belief.drag_n_s_m.iter().copied());
    for (name, value) in [("mass", o.belief.mass_kg)].into_iter().chain(drag) {
        assert_eq!(names.next(), Some(format!("controller.believed_{name}").as_str()));
        reals.push(value.to_bits());
    }
    assert_eq!(names.next(), None);
    // An instance tells real numbers first.
    reals.extend(whole);
    reals
}

/// Each kind of controller, on noisy outputs alone, is the engine's too.
#[test]
fn every_kind_of_controller_is_the_engines() {
    let kinds = [ControllerKind::Lmpc, ControllerKind::StateSpaceMpc, ControllerKind::Dlqr];
    for (number, kind) in (1..).zip(kinds) {
        let mut configuration = Configuration::default();
        configuration.controllers.kind = kind;
        configuration.controllers.governor = false;
        configuration.reference.shaping = false;
        configuration.sensors = Sensors {
            output_feedback: true,
            position_noise_m: 0.02,
            attitude_noise_rad: 0.004,
            seed: 9,
            ..Sensors::default()
        };
        let mut instance = Instance::new(closed_loop());
        let noise = [("sensor.position_noise", 0.02), ("sensor.attitude_noise", 0.004)];
        assert_eq!(instance.set_real(&noise), OK);
        assert_eq!(instance.set_integer(&[("controller.kind", number), ("sensor.seed", 9)]), OK);
        let switches =
            [("controller.governor", false), ("reference.shaping", false), ("sensor.output_feedback", true)];
        assert_eq!(instance.set_boolean(&switches), OK);
        instance.initialize();
        let inputs = Inputs::default();
        let mut engine = Simulation::new(&configuration, &inputs).expect("a valid configuration");
        let mut limited = 0;
        for i in 0..200_u32 {
            instance.fly(f64::from(i) * 0.02, 0.02, 1);
            engine.advance_to(u64::from(i + 1) * 20_000, &inputs).expect("it flies");
            assert_eq!(instance.outputs(), bits(&engine.outputs()), "{kind:?} after step {i}");
            limited += instance.integer("controller.position.active_constraints");
        }
        assert!(limited > 0, "{kind:?}: no limit was met");
    }
}

/// Nothing set: the paper's flight, to 5 m north, 5 m east and 10 m up.
#[test]
fn default_flight_arrives() {
    let mut instance = Instance::initialized(closed_loop(), &[], &[]);
    assert_eq!(instance.reals(["position.x", "position.y", "position.z"]), [0.0; 3]);
    instance.fly(0.0, 0.025, 800);
    let [x, y, z] = instance.reals(["position.x", "position.y", "position.z"]);
    assert!((x - 5.0).abs() < 1e-3 && (y - 5.0).abs() < 1e-3 && (z + 10.0).abs() < 1e-3, "{x} {y} {z}");
    let speeds = instance.reals(["velocity.x", "velocity.y", "velocity.z"]);
    assert!(speeds.iter().all(|speed| speed.abs() < 1e-3), "{speeds:?}");
}

#[test]
fn default_flight_is_the_engines() {
    let (configuration, inputs) = (Configuration::default(), Inputs::default());
    let mut engine = Simulation::new(&configuration, &inputs).expect("the defaults are valid");
    let mut instance = Instance::initialized(closed_loop(), &[], &[]);
    assert_eq!(instance.outputs(), bits(&engine.outputs()));
    for i in 1..=2000_u32 {
        assert_eq!(instance.do_step(f64::from(i - 1) * 0.007, 0.007), OK);
        engine.advance_to(u64::from(i) * 7_000, &inputs).expect("it flies");
        assert_eq!(instance.outputs(), bits(&engine.outputs()), "after step {i}");
    }
}

/// With other parameters, every input in use and changing, and a retuning on the way.
#[test]
fn eventful_flight_is_the_engines() {
    let mut configuration = Configuration::default();
    configuration.airframe.mass_kg = 0.9;
    configuration.airframe.drag_n_s_m = [0.1, 0.2, 0.3];
    configuration.reference.shaping = false;
    configuration.initial.position_m = [1.0, 2.0, -3.0];
    configuration.initial.attitude_rad = [0.2, -0.1, 0.5];
    configuration.controllers.position.terms = 7;
    configuration.limits.thrust_max = 2.5;
    let at = |time_s: f64| {
        let mut inputs = Inputs::default();
        inputs.reference.position_m = [2.0 * time_s.sin(), 2.0 * time_s.cos(), -4.0 - time_s].into();
        inputs.reference.velocity_m_s = [2.0 * time_s.cos(), -2.0 * time_s.sin(), -1.0].into();
        inputs.reference.acceleration_m_s2 = [-2.0 * time_s.sin(), -2.0 * time_s.cos(), 0.0].into();
        inputs.reference.yaw_rad = 0.3 * time_s;
        inputs.reference.yaw_rate_rad_s = 0.3;
        inputs.disturbance.force_n = [0.3, -0.2, 0.1].into();
        inputs.disturbance.torque_n_m = [0.01, -0.01, 0.005 * time_s].into();
        inputs.disturbance.wind_m_s = [3.0, -1.0, 0.5 * time_s].into();
        inputs.ground_z_m = -0.2 * time_s;
        inputs.armed = time_s < 4.0;
        inputs
    };
    let mut instance = Instance::new(closed_loop());
    let parameters = [
        ("airframe.mass", 0.9),
        ("airframe.drag.x", 0.1),
        ("airframe.drag.y", 0.2),
        ("airframe.drag.z", 0.3),
        ("initial.position.x", 1.0),
        ("initial.position.y", 2.0),
        ("initial.position.z", -3.0),
        ("initial.attitude.phi", 0.2),
        ("initial.attitude.theta", -0.1),
        ("initial.attitude.psi", 0.5),
        ("limits.thrust.max", 2.5),
    ];
    assert_eq!(instance.set_real(&parameters), OK);
    assert_eq!(instance.set_integer(&[("controller.position.terms", 7)]), OK);
    assert_eq!(instance.set_boolean(&[("reference.shaping", false)]), OK);
    set(&mut instance, &at(0.0));
    instance.initialize();
    let mut engine = Simulation::new(&configuration, &at(0.0)).expect("a valid configuration");
    for i in 0..250_u32 {
        let time_s = f64::from(i) * 0.02;
        let inputs = at(time_s);
        set(&mut instance, &inputs);
        if i == 100 {
            configuration.controllers.altitude.increment_weight[0] = 2.0;
            engine.reconfigure(&configuration).expect("a tunable weight");
            assert_eq!(instance.set_real(&[("controller.altitude.increment_weight", 2.0)]), OK);
        }
        assert_eq!(instance.do_step(time_s, 0.02), OK, "{:?}", instance.log.take());
        engine.advance_to(u64::from(i + 1) * 20_000, &inputs).expect("it flies");
        assert_eq!(instance.outputs(), bits(&engine.outputs()), "after step {i}");
    }
}

fn set(instance: &mut Instance, inputs: &Inputs) {
    let groups = [
        ("reference.position", inputs.reference.position_m),
        ("reference.velocity", inputs.reference.velocity_m_s),
        ("reference.acceleration", inputs.reference.acceleration_m_s2),
        ("disturbance.force", inputs.disturbance.force_n),
        ("disturbance.torque", inputs.disturbance.torque_n_m),
        ("wind.velocity", inputs.disturbance.wind_m_s),
    ];
    for (group, vector) in groups {
        let names = ["x", "y", "z"].map(|axis| format!("{group}.{axis}"));
        let values: Vec<_> = names.iter().map(String::as_str).zip(vector.iter().copied()).collect();
        assert_eq!(instance.set_real(&values), OK);
    }
    let reference = &inputs.reference;
    let others = [
        ("reference.yaw", reference.yaw_rad),
        ("reference.yaw_rate", reference.yaw_rate_rad_s),
        ("ground.z", inputs.ground_z_m),
    ];
    assert_eq!(instance.set_real(&others), OK);
    assert_eq!(instance.set_boolean(&[("armed", inputs.armed)]), OK);
}

/// Each continuous input at both ends of its range, for a flight of 5 s, and beyond it.
#[test]
fn any_input_is_flown_refused_or_ends_the_flight_by_name() {
    let subject = closed_loop();
    let inputs = subject.description.variables.iter();
    let inputs = inputs.filter(|variable| variable.causality == "input" && variable.value_type == "Real");
    let mut ended = Vec::new();
    for input in inputs {
        for value in ["min", "max"].map(|end| input.number(end).expect("inputs have ranges")) {
            let mut instance = Instance::initialized(subject, &[], &[]);
            for beyond in [value * 1.001, value.signum() * 1e300, f64::NAN] {
                assert_eq!(instance.set_real(&[(&input.name, beyond)]), ERROR);
                let text = instance.log.last().text;
                let (_, told) = text.split_once(&format!("{} = ", input.name)).expect("its name and value");
                let told: f64 =
                    told.split([' ', ';']).next().and_then(|told| told.parse().ok()).expect("a number");
                assert!(told == beyond || told.is_nan() && beyond.is_nan(), "{text}");
            }
            assert_eq!(instance.set_real(&[(&input.name, value)]), OK);
            let mut step = 0;
            while step < 50 && instance.do_step(f64::from(step) * 0.1, 0.1) == OK {
                step += 1;
            }
            // Those that can be read at all are.
            assert!(
                instance.outputs().into_iter().all(|bits| f64::from_bits(bits).is_finite()),
                "{}",
                input.name
            );
            if step < 50 {
                let text = instance.log.last().text;
                assert!(text.contains("the flight cannot continue: the motion has diverged at "), "{text}");
                let cause = format!("{} = {value:?} N·m exceeds what the rotors can counter", input.name);
                assert!(text.contains(&cause), "{text}");
                ended.push(input.name.as_str());
            }
        }
    }
    // 1000 N·m turn the vehicle by more than a revolution in an integration step.
    assert_eq!(ended, ["x", "x", "y", "y", "z", "z"].map(|axis| format!("disturbance.torque.{axis}")));
}

/// A jerk limit that is lowered while the vehicle comes down holds as far as the descent can keep it: at 1 m/s³ from the first
/// second on it would end in the ground.
#[test]
fn a_lowered_limit_leads_no_flight_past_its_goal() {
    let subject = closed_loop();
    for (goal_z_m, jerk_m_s3) in [(-3.0, 1.0), (-20.0, 0.4)] {
        let start = [("initial.position.z", -10.0), ("reference.position.z", goal_z_m)];
        let level = [("reference.position.x", 0.0), ("reference.position.y", 0.0)];
        let mut instance = Instance::initialized(subject, &[start, level].concat(), &[]);
        instance.fly(0.0, 0.1, 10);
        assert_eq!(instance.set_real(&[("limits.jerk.vertical", jerk_m_s3)]), OK);
        let mut beyond_m: f64 = 0.0;
        for step in 10..400 {
            instance.fly(0.1 * f64::from(step), 0.1, 1);
            let z_m = instance.real("position.z");
            beyond_m = beyond_m.max((z_m - goal_z_m) * (goal_z_m + 10.0).signum());
        }
        assert!(beyond_m < 0.02, "{beyond_m} m past {goal_z_m} m");
        assert!((instance.real("position.z") - goal_z_m).abs() < 0.01);
    }
}

/// Height is positive up, and zero is positive, too.
#[test]
fn altitude_is_the_position_upwards() {
    for down in [0.0, -12.5, 3.0] {
        let mut instance = Instance::initialized(
            closed_loop(),
            &[("initial.position.z", down)],
            &[("environment.ground_plane", false)],
        );
        let [altitude, z] = instance.reals(["altitude", "position.z"]);
        assert_eq!((altitude, z), (-down, down));
        assert!(altitude != 0.0 || altitude.is_sign_positive());
        instance.fly(0.0, 0.1, 10);
        let [altitude, z] = instance.reals(["altitude", "position.z"]);
        assert_eq!(altitude, -z);
    }
}

/// A reference that is passed on as it comes is the set-point from the beginning, not only from the first sample on. The heading
/// begins where the vehicle points: it turns to its reference within its limit.
#[test]
fn an_unshaped_setpoint_is_the_reference_from_the_beginning() {
    let kinds = ["position", "velocity", "acceleration"];
    let names: Vec<(String, String)> =
        (kinds.iter().flat_map(|kind| "xyz".chars().map(move |axis| (kind, axis))))
            .map(|(kind, axis)| (format!("reference.{kind}.{axis}"), format!("setpoint.{kind}.{axis}")))
            .collect();
    let values: Vec<(&str, f64)> = (1..)
        .zip(&names)
        .map(|(number, (reference, _))| (reference.as_str(), 0.1 * f64::from(number)))
        .collect();
    let started = |shaping| {
        let mut instance = Instance::new(closed_loop());
        assert_eq!(instance.set_real(&values), OK);
        assert_eq!(instance.set_real(&[("reference.yaw", 1.0), ("initial.position.x", 2.0)]), OK);
        assert_eq!(instance.set_boolean(&[("reference.shaping", shaping)]), OK);
        instance.initialize();
        instance
    };
    let mut unshaped = started(false);
    for ((reference, setpoint), (_, value)) in names.iter().zip(&values) {
        assert_eq!(unshaped.real(setpoint), *value, "{setpoint} is {reference}");
    }
    let [error, heading] = unshaped.reals(["tracking_error.x", "setpoint.yaw"]);
    assert_eq!((error, heading), (2.0 - 0.1, 0.0));
    // What is shaped begins where the vehicle is.
    let [position, velocity] = started(true).reals(["setpoint.position.x", "setpoint.velocity.x"]);
    assert_eq!((position, velocity), (2.0, 0.0));
}
