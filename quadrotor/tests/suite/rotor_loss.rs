//! Flights with broken rotors.

use nalgebra::Vector3;
use quadrotor::{
    Configuration, ControlLaw, Inputs, Outputs, PositionReference, RotorFault, RotorMonitor, Simulation,
};

use crate::common::tilt_rad;

/// Height of the flights, m.
const HEIGHT_M: f64 = 20.0;
/// Sink rate that is asked for once a rotor is lost, m/s.
const SINK_M_S: f64 = 1.5;
/// When the fault begins, s.
const FAULT_S: f64 = 1.0;

/// What came of a flight.
#[derive(Debug)]
struct Course {
    /// From the fault until the loss of a rotor was known, s.
    known_after_s: Option<f64>,
    /// Largest angle between thrust axis and vertical, rad.
    tilt_rad: f64,
    /// Farthest from where the fault began, horizontally, m.
    drift_m: f64,
    /// Largest sink rate, m/s.
    sink_m_s: f64,
    /// Just above the ground, or at the end.
    end: Outputs,
}

/// A point that moves at a velocity, NED, m/s, from (0, 0, -20) on.
fn moving(velocity_m_s: [f64; 3]) -> impl Fn(f64) -> PositionReference {
    move |time_s| {
        let velocity_m_s = Vector3::from(velocity_m_s);
        let start = PositionReference::goal([0.0, 0.0, -HEIGHT_M], 0.0);
        PositionReference { position_m: start.position_m + velocity_m_s * time_s, velocity_m_s, ..start }
    }
}

/// Flies a reference with a fault that begins after a second, and, once a rotor is known to be lost, descends where it
/// comes to rest.
fn course(
    faults: [Option<RotorFault>; 4],
    seconds: f64,
    reference: impl Fn(f64) -> PositionReference,
) -> Course {
    course_of(&Configuration::default(), faults, seconds, reference)
}

fn course_of(
    configuration: &Configuration,
    faults: [Option<RotorFault>; 4],
    seconds: f64,
    reference: impl Fn(f64) -> PositionReference,
) -> Course {
    let mut configuration = *configuration;
    configuration.environment.ground_plane = true;
    configuration.reference.shaping = false;
    let start = reference(0.0);
    configuration.initial.position_m = start.position_m.into();
    configuration.initial.velocity_m_s = start.velocity_m_s.into();
    let mut inputs = Inputs { reference: start, ..Inputs::default() };
    let mut flight = Simulation::new(&configuration, &inputs).unwrap();
    let mut monitor = RotorMonitor::new(flight.outputs().rotor_speed_rad_s);
    let mut course =
        Course { known_after_s: None, tilt_rad: 0.0, drift_m: 0.0, sink_m_s: 0.0, end: flight.outputs() };
    let mut broke_at = Vector3::zeros();
    let mut rest = None;
    for millisecond in 1..=(seconds * 1e3) as u64 {
        let (time_s, command) = (millisecond as f64 * 1e-3, flight.rotor_command_rad_s());
        inputs.reference = reference(time_s);
        if inputs.lost_rotor.is_some() {
            let now = flight.outputs();
            if course.known_after_s.is_some_and(|s| time_s > FAULT_S + s + 2.0)
                && now.velocity_m_s.xy().norm() < 0.5
            {
                rest = rest.or(Some(now.position_m));
            }
            let place = rest.unwrap_or(now.position_m);
            inputs.reference = PositionReference {
                velocity_m_s: Vector3::new(0.0, 0.0, SINK_M_S),
                ..PositionReference::goal([place.x, place.y, now.position_m.z], 0.0)
            };
        }
        if time_s == FAULT_S {
            inputs.rotor_faults = faults;
            broke_at = flight.outputs().position_m;
        }
        flight.advance_to(millisecond * 1000, &inputs).unwrap();
        let outputs = flight.outputs();
        if let Some(lost) =
            monitor.update(&configuration.airframe, &command, &outputs.rotor_speed_rad_s, 1e-3)
        {
            course.known_after_s.get_or_insert(time_s - FAULT_S);
            inputs.lost_rotor.get_or_insert(lost);
        }
        // A tilted vehicle's lowest foot.
        if outputs.position_m.z > -0.1 {
            break;
        }
        course.tilt_rad = course.tilt_rad.max(tilt_rad(&outputs));
        course.sink_m_s = course.sink_m_s.max(outputs.velocity_m_s.z);
        if time_s >= FAULT_S {
            course.drift_m = course.drift_m.max((outputs.position_m - broke_at).xy().norm());
        }
        course.end = outputs;
    }
    course
}

fn broken(index: usize, fault: RotorFault) -> [Option<RotorFault>; 4] {
    let mut faults = [None; 4];
    faults[index] = Some(fault);
    faults
}

/// The bars of a loss: measured 35° to 37°, 1.59 m/s at the most, and down to the ground at the asked rate.
fn assert_lands(course: &Course, drift_m: f64) {
    assert!(course.known_after_s.is_some_and(|after_s| after_s < 0.1), "{course:?}");
    assert!(course.tilt_rad < 40_f64.to_radians(), "it tumbles: {course:?}");
    assert!(course.sink_m_s < 1.7, "{course:?}");
    assert!(course.drift_m < drift_m, "{course:?}");
    let end = &course.end;
    assert!((end.position_m.z + 0.1).abs() < 0.01, "it does not come down: {course:?}");
    assert!(end.velocity_m_s.z < 1.6 && end.velocity_m_s.xy().norm() < 0.6, "{course:?}");
    assert!(tilt_rad(end) < 12_f64.to_radians(), "{course:?}");
}

#[test]
fn without_any_one_rotor_it_descends_from_hover() {
    let courses: Vec<_> =
        (0..4).map(|index| course(broken(index, RotorFault::Off), 40.0, moving([0.0; 3]))).collect();
    for course in &courses {
        // Measured: 24 m.
        assert_lands(course, 27.0);
        // The heading is given up: it spins in the way of the two rotors beside the lost one.
        assert!((6.0..8.0).contains(&course.end.body_rate_rad_s.z.abs()), "{course:?}");
    }
    // The four are the same flight but for the direction.
    for course in &courses {
        assert!((course.tilt_rad - courses[0].tilt_rad).abs() < 1e-6, "{course:?}");
        assert!((course.drift_m - courses[0].drift_m).abs() < 1e-3, "{course:?}");
    }
}

#[test]
fn without_a_rotor_it_descends_from_five_metres_per_second() {
    // Measured: 12 to 57 m. For two seconds it cannot brake, see `a_thrust_axis_needs_spin`.
    for velocity in [[5.0, 0.0, 0.0], [-5.0, 0.0, 0.0], [0.0, 5.0, 0.0], [0.0, -5.0, 0.0]] {
        assert_lands(&course(broken(0, RotorFault::Off), 40.0, moving(velocity)), 62.0);
    }
}

/// Why it leans by 35° at first. Without spin the pitch is driven by the opposite rotor alone, which can only push and at
/// least idles: the lost rotor's momentum while the loss is not known, and the idling from there on, turn the nose down
/// until the spin has turned the roll axis to where the pitch axis was.
#[test]
fn a_thrust_axis_needs_spin() {
    let airframe = Configuration::default().airframe;
    let k1 = airframe.thrust_coefficient_n_s2;
    let [_, jy, jz] = airframe.inertia_kg_m2;
    // Two rotors carry the weight with 63 % of what they can: the thrust is not what is missing.
    let strongest_n = k1 * airframe.rotor_speed_max_rad_s.powi(2);
    assert!(airframe.weight_n() / 2.0 < 0.65 * strongest_n);
    // They drive the spin at 0.72 rad/s²: a quarter of a turn takes 2.1 s …
    let spin_rad_s2 = airframe.torque_coefficient_n_m_s2 / k1 * airframe.weight_n() / jz;
    let quarter_s = (core::f64::consts::PI / spin_rad_s2).sqrt();
    assert!((2.0..2.2).contains(&quarter_s), "{quarter_s}");
    // … and in that time the idling rotor alone turns the nose by 22°.
    let idling_rad_s2 = airframe.arm_length_m * k1 * airframe.rotor_speed_min_rad_s.powi(2) / jy;
    let turned = 0.5 * idling_rad_s2 * quarter_s * quarter_s;
    assert!((20.0..24.0).contains(&turned.to_degrees()), "{}", turned.to_degrees());
}

/// The steady spin: ω ∥ n, lean β = 0.14 rad, and no torque about the thrust axis when the opposite rotor makes half of
/// the thrust F = m g / cos β, so that l F/2 = (J_z − J_x) r² tan β.
#[test]
fn the_spin_settles_where_the_rotors_drag_balances() {
    let mut configuration = Configuration::default();
    configuration.initial.position_m[2] = -100.0;
    let mut inputs =
        Inputs { reference: PositionReference::goal([0.0, 0.0, -100.0], 0.0), ..Inputs::default() };
    let mut flight = Simulation::new(&configuration, &inputs).unwrap();
    inputs.rotor_faults = broken(0, RotorFault::Off);
    flight.advance_to(60_000, &inputs).unwrap();
    inputs.lost_rotor = Some(0);
    let mut lost_m: f64 = 0.0;
    for step in 7..=6_000 {
        flight.advance_to(step * 10_000, &inputs).unwrap();
        lost_m = lost_m.max(flight.outputs().position_m.z + 100.0);
    }
    let airframe = configuration.airframe;
    let [jx, _, jz] = airframe.inertia_kg_m2;
    let lean_rad: f64 = 0.14;
    let thrust_n = airframe.weight_n() / lean_rad.cos();
    let spin = (airframe.arm_length_m * thrust_n / 2.0 / ((jz - jx) * lean_rad.tan())).sqrt();
    let end = flight.outputs();
    assert!((end.body_rate_rad_s.norm() / (spin / lean_rad.cos()) - 1.0).abs() < 0.02, "{spin}: {end:?}");
    assert!((tilt_rad(&end) - lean_rad).abs() < 0.01, "{end:?}");
    // It holds its place, and hardly lost height on the way there.
    assert!((end.position_m - inputs.reference.position_m).norm() < 0.5, "{end:?}");
    assert!(lost_m < 0.2, "{lost_m}");
}

#[test]
fn a_vehicle_too_heavy_for_two_rotors_falls_faster() {
    let mut configuration = Configuration::default();
    // Two rotors make 10.9 N at the most, this weighs 12.3 N.
    configuration.airframe.mass_kg = 1.25;
    let course = course_of(&configuration, broken(0, RotorFault::Off), 40.0, moving([0.0; 3]));
    // Measured: 40° and 6.5 m/s: no tumble, and no landing either.
    assert!(course.tilt_rad < 45_f64.to_radians() && course.sink_m_s > 5.0, "{course:?}");
}

#[test]
fn a_weak_rotor_is_no_loss() {
    for (share, tilt_deg) in [(0.7, 1.5), (0.55, 2.5)] {
        for velocity in [[0.0; 3], [5.0, 0.0, 0.0]] {
            let course = course(broken(0, RotorFault::Weak { share }), 10.0, moving(velocity));
            assert_eq!(course.known_after_s, None);
            assert!(course.tilt_rad < f64::to_radians(tilt_deg), "{course:?}");
            let reference = moving(velocity)(10.0);
            assert!((course.end.position_m - reference.position_m).norm() < 0.05, "{course:?}");
            assert!(course.end.attitude_rad.norm() < 0.01, "the heading is held: {course:?}");
        }
    }
}

/// Stuck at hover speed it hovers on; the loss is found when another speed is asked for, and the rest is a descent
/// without spin, or with little.
#[test]
fn a_stuck_rotor_is_found_when_it_matters() {
    let hover = course(broken(0, RotorFault::Stuck), 10.0, moving([0.0; 3]));
    assert!(hover.known_after_s.is_none() && hover.tilt_rad < 1e-3, "{hover:?}");
    // Swings in height and to the front and back: stuck at many speeds.
    for (height_m, rate_rad_s) in [(0.0, 1.0), (0.0, 3.0), (0.2, 2.0), (0.5, 2.0), (0.5, 3.0)] {
        let swing = |time_s: f64| {
            let (sine, cosine) = (rate_rad_s * time_s).sin_cos();
            let amplitude = Vector3::new((3.0 / (rate_rad_s * rate_rad_s)).min(2.0), 0.0, height_m);
            PositionReference {
                position_m: Vector3::new(0.0, 0.0, -HEIGHT_M) + amplitude * sine,
                velocity_m_s: amplitude * rate_rad_s * cosine,
                acceleration_m_s2: -amplitude * rate_rad_s * rate_rad_s * sine,
                ..PositionReference::goal([0.0; 3], 0.0)
            }
        };
        let course = course(broken(0, RotorFault::Stuck), 40.0, swing);
        // A vehicle that leans as far as it may when the rotor sticks is beyond the law for a lost rotor, which has no spin yet: it is
        // asked for accelerations that leave the lean half of its limit. A swing of 18 m/s² lets it stick at 375 rad/s, where it and
        // the opposite rotor, which has to balance it, carry 1.1 times the weight: no law comes to rest then, and the vehicle ends
        // at 36 to 38 m/s whether the Laguerre MPC or the regulator flew before.
        assert!(course.known_after_s.is_some() && course.tilt_rad < 32_f64.to_radians(), "{course:?}");
        assert!((course.end.position_m.z + 0.1).abs() < 0.01 && course.sink_m_s < 1.7, "{course:?}");
        assert!(course.drift_m < 32.0 && course.end.velocity_m_s.xy().norm() < 1.2, "{course:?}");
    }
}

/// Nothing that a rotor can suffer makes the engine depend on how its time is split.
#[test]
fn a_broken_flight_is_the_same_however_it_is_split() {
    let fly = |steps_us: &[u64]| {
        let mut inputs = Inputs::default();
        let mut flight = Simulation::new(&Configuration::default(), &inputs).unwrap();
        let mut steps = steps_us.iter().cycle();
        for until_us in [2_000_000, 2_080_000, 6_000_000] {
            while flight.time_us() < until_us {
                let next_us = (flight.time_us() + steps.next().unwrap()).min(until_us);
                flight.advance_to(next_us, &inputs).unwrap();
            }
            match until_us {
                2_000_000 => inputs.rotor_faults = broken(2, RotorFault::Off),
                2_080_000 => inputs.lost_rotor = Some(2),
                _ => {}
            }
        }
        flight.outputs()
    };
    assert_eq!(fly(&[1_000]), fly(&[777, 12_345, 3]));
}

#[test]
fn what_is_no_fault_is_refused() {
    let inputs = Inputs::default();
    let mut flight = Simulation::new(&Configuration::default(), &inputs).unwrap();
    for share in [-0.1, 1.1, f64::NAN] {
        let rotor_faults = broken(0, RotorFault::Weak { share });
        assert!(flight.advance_to(1_000_000, &Inputs { rotor_faults, ..inputs }).is_err());
    }
    let lost = Inputs { lost_rotor: Some(4), ..inputs };
    let error = flight.advance_to(1_000_000, &lost).unwrap_err().to_string();
    assert_eq!(error, "lost_rotor = 4; allowed 0–3");
    assert_eq!(flight.control().check_loss_of(4).unwrap_err().to_string(), "lost_rotor = 4; allowed 0–3");
    assert_eq!((flight.law(), flight.time_us()), (ControlLaw::Cascade, 0));
}
