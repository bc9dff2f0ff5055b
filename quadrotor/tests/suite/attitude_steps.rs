//! Steps of the attitude from hundredths of a radian to upside down, for quick and for slow rotors, and spins.

use crate::common::{fly, goal};
use nalgebra::{UnitQuaternion, Vector3};
use quadrotor::{AttitudeTarget, Configuration, Inputs};

/// A roll from hover to an angle, rad: by how much it goes beyond, as a share, and when it stays within 2 %, s.
fn rolled(lag_s: f64, angle_rad: f64) -> (f64, f64) {
    let mut configuration = Configuration::default();
    configuration.airframe.rotor_time_constant_s = lag_s;
    configuration.initial.position_m[2] = -500.0;
    let target = AttitudeTarget {
        attitude: UnitQuaternion::from_axis_angle(&Vector3::x_axis(), angle_rad),
        body_rate_rad_s: Vector3::zeros(),
        thrust_n: configuration.airframe.weight_n(),
    };
    let inputs = Inputs { attitude_target: Some(target), ..Inputs::default() };
    let (mut beyond, mut settled_s) = (0.0_f64, 0.0);
    fly(&configuration, &inputs, 6.0, |outputs| {
        let [w, x, ..] = outputs.quaternion;
        // The shorter way round: a roll a little beyond π is one of almost −π.
        let rolled = 2.0 * x.atan2(w);
        let rolled = if rolled < -1.0 { rolled + std::f64::consts::TAU } else { rolled };
        let error = rolled / angle_rad - 1.0;
        beyond = beyond.max(error);
        if error.abs() > 0.02 {
            settled_s = outputs.time_us as f64 * 1e-6;
        }
    });
    (beyond, settled_s)
}

/// The model knows the rotors' lag and the program their thrusts: steps overshoot by a few percent at any lag and in any size, and take no
/// longer than the lag and the torque ask for.
#[test]
fn steps_of_any_size_settle_without_swinging() {
    for (lag_s, angle_rad, beyond, settled_s) in [
        (0.03, 0.02, 0.04, 0.9),
        (0.03, 1.0, 0.04, 0.9),
        (0.03, 3.0, 0.04, 1.6),
        (0.1, 0.02, 0.05, 1.4),
        (0.1, 1.0, 0.05, 1.4),
        (0.2, 0.02, 0.08, 2.5),
        (0.2, 1.0, 0.08, 2.5),
    ] {
        let flown = rolled(lag_s, angle_rad);
        assert!(flown.0 < beyond && flown.1 < settled_s, "{lag_s} s, {angle_rad} rad: {flown:?}");
    }
}

/// A spin of 15 rad/s about the thrust axis ends about as soon as the largest yaw torque can end it: J_z r/τ.
#[test]
fn a_spin_is_braked_with_the_yaw_torque_that_there_is() {
    const SPIN_RAD_S: f64 = 15.0;
    let mut configuration = Configuration::default();
    configuration.initial.body_rate_rad_s = [0.0, 0.0, SPIN_RAD_S];
    configuration.initial.position_m[2] = -20.0;
    let airframe = &configuration.airframe;
    // In hover each rotor can lose a quarter of the weight less what it makes at its least speed.
    let room_n = (airframe.weight_n() - airframe.thrust_range_n().0) / 4.0;
    let yaw_n_m = 4.0 * room_n * airframe.torque_coefficient_n_m_s2 / airframe.thrust_coefficient_n_s2;
    let least_s = airframe.inertia_kg_m2[2] * SPIN_RAD_S / yaw_n_m;
    let mut turning_s = 0.0;
    let end = fly(&configuration, &goal([0.0, 0.0, -20.0], 0.0), 2.0 * least_s, |outputs| {
        if outputs.body_rate_rad_s.z.abs() > 0.5 {
            turning_s = outputs.time_us as f64 * 1e-6;
        }
    });
    // Measured: 1.49 times as long. Roll and pitch come before yaw.
    assert!(turning_s < 1.6 * least_s, "{turning_s} s, not {least_s} s");
    let outputs = end.outputs();
    assert!((outputs.position_m - Vector3::new(0.0, 0.0, -20.0)).norm() < 0.1, "{outputs:?}");
}
