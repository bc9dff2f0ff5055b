//! Two rotors lost at once: what the law makes of the fall, beside a vehicle whose rotors stop.

use nalgebra::Vector3;
use quadrotor::{
    Configuration, Disturbance, Inputs, Outputs, PositionReference, RotorFault, RotorMonitor, Simulation,
};

/// Height of the flights, m.
const HEIGHT_M: f64 = 10.0;
const SINK_M_S: f64 = 1.5;

/// Hovers for a second in a wind, loses rotors at times, s, and flies until it touches the ground; the speed there, m/s.
fn fall(lost: [(usize, f64); 2], armed: bool, wind_m_s: f64) -> f64 {
    let mut configuration = Configuration::default();
    configuration.airframe.drag_n_s_m = [0.1, 0.1, 0.1];
    configuration.environment.ground_plane = false;
    configuration.reference.shaping = false;
    configuration.initial.position_m = [0.0, 0.0, -HEIGHT_M];
    let hover = PositionReference::goal([0.0, 0.0, -HEIGHT_M], 0.0);
    let disturbance = Disturbance { wind_m_s: Vector3::new(wind_m_s, 0.0, 0.0), ..Disturbance::default() };
    let mut inputs = Inputs { reference: hover, disturbance, ..Inputs::default() };

    let mut flight = Simulation::new(&configuration, &inputs).expect("a flight");
    let mut monitor = RotorMonitor::new(flight.outputs().rotor_speed_rad_s);
    for millisecond in 1..=60_000_u64 {
        let now: Outputs = flight.outputs();
        for (rotor, _) in lost.iter().filter(|(_, when_s)| millisecond as f64 > when_s * 1e3) {
            inputs.rotor_faults[*rotor] = Some(RotorFault::Off);
        }
        if millisecond > 1000 {
            inputs.armed = armed;
        }
        if inputs.lost_rotor.is_some() {
            inputs.reference = PositionReference {
                velocity_m_s: Vector3::new(0.0, 0.0, SINK_M_S),
                position_m: now.position_m,
                ..hover
            };
        }
        let command = flight.rotor_command_rad_s();
        flight.advance_to(millisecond * 1000, &inputs).expect("finite");
        let measured = flight.outputs().rotor_speed_rad_s;
        let known = monitor.update(&configuration.airframe, &command, &measured, 1e-3);
        inputs.lost_rotor = inputs.lost_rotor.or(known.filter(|_| millisecond > 1000));
        let after = flight.outputs();
        if after.position_m.z >= 0.0 {
            return after.velocity_m_s.norm();
        }
    }
    panic!("it never came down")
}

/// √(2 g h) = 14 m/s from 10 m.
#[test]
fn rotors_that_stop_let_it_fall_freely() {
    let speed_m_s = fall([(0, 1.0), (2, 1.0)], false, 0.0);
    assert!((12.0..14.1).contains(&speed_m_s), "{speed_m_s} m/s");
}

/// At once, or the second one while the first is being flown without, when it leans and spins; in still air and in a wind. Measured: 1.4,
/// 7.7 and 3.0 m/s.
#[test]
fn two_opposite_rotors_carry_it_down() {
    for (one, other) in [(0, 2), (2, 0), (1, 3)] {
        for (later_s, wind_m_s, most_m_s) in [(0.0, 0.0, 2.0), (3.0, 0.0, 9.0), (0.0, 3.0, 4.0)] {
            let speed_m_s = fall([(one, 1.0), (other, 1.0 + later_s)], true, wind_m_s);
            assert!(
                speed_m_s < most_m_s,
                "{one}, {other} {later_s} s later in {wind_m_s} m/s: {speed_m_s} m/s"
            );
        }
    }
}

#[test]
fn two_rotors_side_by_side_can_do_nothing_and_do_no_harm() {
    let speed_m_s = fall([(0, 1.0), (1, 1.0)], true, 0.0);
    assert!(speed_m_s < 14.1, "{speed_m_s} m/s");
}
