//! At the upper end of the thrust attitude comes first, and what the altitude controller asks for is kept.

use crate::common;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use quadrotor::{AttitudeTarget, Configuration, ControllerKind, Inputs, RotorLayout, Simulation};

use crate::common::{KINDS, goal, unshaped};

/// A flight under an attitude target after a hover in wind: for each 20 ms its time, s, the angle to the target, degrees, and the
/// thrust as a share of the largest.
fn at_full_thrust(
    configuration: &Configuration,
    [roll_deg, pitch_deg, yaw_deg]: [f64; 3],
    wind_m_s: [f64; 3],
    duration_s: f64,
) -> Vec<[f64; 3]> {
    const HOVERED_US: u64 = 20_000_000;
    let strongest_n = configuration.airframe.thrust_range_n().1;
    let mut hover = goal([0.0, 0.0, -20.0], 0.0);
    hover.disturbance.wind_m_s = wind_m_s.into();
    let mut simulation = Simulation::new(configuration, &hover).unwrap();
    simulation.advance_to(HOVERED_US, &hover).unwrap();
    let angles = [roll_deg, pitch_deg, yaw_deg].map(f64::to_radians);
    let attitude = UnitQuaternion::from_euler_angles(angles[0], angles[1], angles[2]);
    let target = AttitudeTarget { attitude, body_rate_rad_s: Vector3::zeros(), thrust_n: strongest_n };
    let inputs = Inputs { attitude_target: Some(target), ..hover };
    let seen = |step: u64| {
        simulation.advance_to(HOVERED_US + step * 20_000, &inputs).unwrap();
        let outputs = simulation.outputs();
        let [w, x, y, z] = outputs.quaternion;
        let error = UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z)).angle_to(&attitude);
        [step as f64 * 0.02, error.to_degrees(), outputs.thrust_n / strongest_n]
    };
    (1..=(duration_s * 50.0) as u64).map(seen).collect()
}

/// Time from which on the angle to the target stays below 2°, s.
fn settled_s(flight: &[[f64; 3]]) -> f64 {
    flight.iter().rev().find(|[_, error, _]| *error > 2.0).map_or(0.0, |[time_s, ..]| *time_s)
}

#[test]
fn a_lean_is_reached_at_full_thrust_in_any_direction() {
    for (layout, kind) in [
        (RotorLayout::plus(), ControllerKind::Lmpc),
        (RotorLayout::x(), ControllerKind::StateSpaceMpc),
        (RotorLayout::h(1.5), ControllerKind::Dlqr),
    ] {
        for wind_m_s in [[0.0; 3], [0.0, 10.0, 0.0]] {
            let mut configuration = Configuration::default();
            configuration.controllers.kind = kind;
            configuration.airframe.layout = layout;
            configuration.airframe.drag_n_s_m = [0.25; 3];
            for direction in 0..8 {
                let (east, north) = f64::from(direction).mul_add(core::f64::consts::FRAC_PI_4, 0.1).sin_cos();
                let lean = [20.0 * east, -20.0 * north, 0.0];
                let flight = at_full_thrust(&configuration, lean, wind_m_s, 4.0);
                let told = format!("{kind:?}, {layout:?}, lean {lean:?}, wind {wind_m_s:?}");
                assert!(settled_s(&flight) < 1.5, "{told}: {} s", settled_s(&flight));
                // The thrust gives way no longer than that takes.
                let end = flight.last().unwrap();
                assert!(end[2] > 0.99 && end[1] < 0.5, "{told}: {end:?}");
            }
        }
    }
}

/// With a payload that needs three quarters of the thrust to hover, too, and without sinking.
#[test]
fn a_heavy_vehicle_leans_and_turns_at_full_thrust() {
    for kind in KINDS {
        let mut configuration = Configuration::default();
        configuration.controllers.kind = kind;
        configuration.airframe.mass_kg = 1.7;
        let flight = at_full_thrust(&configuration, [0.0, -20.0, 0.0], [0.0; 3], 4.0);
        assert!(settled_s(&flight) < 2.0, "{kind:?}: {} s", settled_s(&flight));
        let hovering = configuration.airframe.hover_thrust_share();
        assert!(flight.iter().skip(10).all(|[.., thrust]| *thrust > 0.98 * hovering), "{kind:?}");
        // Yaw has little torque, at full thrust 15 % of the rotors' range.
        let flight = at_full_thrust(&configuration, [0.0, 0.0, 60.0], [0.0; 3], 12.0);
        let end = flight.last().unwrap();
        assert!(end[1] < 3.0 && end[2] > 0.98, "{kind:?}: {end:?}");
    }
}

/// The altitude controller leaves the torques their reserve, and its thrust is kept: a raw step in all directions under a payload
/// that its model knows by 80 % only saturates roll and pitch for seconds, and would bring the vehicle down by tens of metres.
#[test]
fn a_hard_step_with_a_payload_does_not_cost_its_altitude() {
    for kind in KINDS {
        let mut configuration = unshaped();
        configuration.controllers.kind = kind;
        configuration.airframe.mass_kg = 1.7;
        configuration.controllers.mass_factor = 0.8;
        let goal_m = [20.0, -20.0, -30.0];
        let mut inputs = goal(goal_m, 2.0);
        inputs.disturbance.force_n = Vector3::new(0.5, 0.5, 0.0);
        let mut lowest_m = 0.0_f64;
        let simulation = common::fly(&configuration, &inputs, 25.0, |outputs| {
            lowest_m = lowest_m.max(outputs.position_m.z)
        });
        assert!(lowest_m < 0.6, "{kind:?} sank by {lowest_m} m");
        let left_m = common::distance(&simulation.outputs(), goal_m);
        assert!(left_m < 0.1, "{kind:?}: {left_m} m from its goal");
    }
}
