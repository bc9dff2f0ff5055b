//! The outputs.
//!
//! Outputs at a communication point do not depend on the inputs set there: these act from then on.

use std::f64::consts::PI;

use fmi::array;
use fmi::variables::{Array, Variable};
use quadrotor::{BatteryOutput, Belief, Outputs, PositionReference};

use super::ClosedLoop;
use crate::quantities::{ANGLE, POSITION};
use crate::tables::rows::{output, within};
use crate::tables::{motion, steering};

const ATTITUDE: &[&str] = &["initial.attitude."];

/// The motion of the vehicle, its rotors and its battery.
pub(super) const MOTION: [Variable<ClosedLoop>; 34] = motion::motion();

/// What the controllers steer by.
pub(super) const STEERING: [Variable<ClosedLoop>; 12] = steering::set_points();

/// How far the vehicle is from there.
#[rustfmt::skip]
pub(super) const ERRORS: [Variable<ClosedLoop>; 4] = [
    output("tracking_error.x", &POSITION, &["armed", "reference.position.x", "reference.shaping", "initial.position.x"], |outputs: &Outputs| outputs.tracking_error_m.x, "Position minus set-point north"),
    output("tracking_error.y", &POSITION, &["armed", "reference.position.y", "reference.shaping", "initial.position.y"], |outputs: &Outputs| outputs.tracking_error_m.y, "Position minus set-point east"),
    output("tracking_error.z", &POSITION, &["armed", "reference.position.z", "reference.shaping", "initial.position.z"], |outputs: &Outputs| outputs.tracking_error_m.z, "Position minus set-point down"),
    within(output("yaw_error", &ANGLE, ATTITUDE, |outputs: &Outputs| outputs.yaw_error_rad, "Heading minus set-point, wrapped to [-pi, pi]"), -PI, PI),
];

/// How the controllers came to their last inputs.
pub(super) const ACTIVITY: [Variable<ClosedLoop>; 12] = steering::activity();

/// What the controllers take the vehicle for.
pub(super) const BELIEF: [Variable<ClosedLoop>; 4] = steering::belief();

/// Arrays that only the closed loop has.
pub(super) const ARRAYS: &[Array] =
    &[array!("tracking_error", [".x", ".y", ".z"], "Position minus set-point: north, east, down")];

/// Whether all numbers of the outputs are finite, and so is their sum.
pub(super) fn are_finite(outputs: &Outputs) -> bool {
    let Outputs {
        position_m,
        velocity_m_s,
        acceleration_m_s2,
        body_velocity_m_s,
        attitude_rad,
        quaternion,
        body_rate_rad_s,
        thrust_n,
        torque_n_m,
        rotor_speed_rad_s,
        battery: BatteryOutput { voltage_v, current_a, remaining },
        tilt_reference_rad,
        setpoint,
        tracking_error_m,
        yaw_error_rad,
        belief: Belief { mass_kg, drag_n_s_m },
        // Whole numbers.
        time_us: _,
        activity: _,
    } = outputs;
    let PositionReference { yaw_rad, yaw_rate_rad_s, yaw_acceleration_rad_s2, .. } = setpoint;
    let vectors = [
        position_m,
        velocity_m_s,
        acceleration_m_s2,
        body_velocity_m_s,
        attitude_rad,
        body_rate_rad_s,
        torque_n_m,
        tracking_error_m,
        drag_n_s_m,
        &setpoint.position_m,
        &setpoint.velocity_m_s,
        &setpoint.acceleration_m_s2,
        &setpoint.jerk_m_s3,
        &setpoint.snap_m_s4,
    ];
    let numbers = [
        *thrust_n,
        *voltage_v,
        *current_a,
        *remaining,
        *yaw_error_rad,
        *mass_kg,
        *yaw_rad,
        *yaw_rate_rad_s,
        *yaw_acceleration_rad_s2,
    ];
    // A sum with a number that is not finite is not finite.
    let mut total: f64 = vectors.iter().map(|vector| vector.sum()).sum();
    for group in [&numbers[..], quaternion, rotor_speed_rad_s, tilt_reference_rad] {
        total += group.iter().sum::<f64>();
    }
    total.is_finite()
}

#[cfg(test)]
mod tests {
    use fmi::Model;
    use quadrotor::{Configuration, Inputs, Outputs};

    use super::{ClosedLoop, are_finite};

    #[test]
    fn a_single_number_that_is_not_finite_is_found() {
        let outputs =
            ClosedLoop::new(&Configuration::default(), &Inputs::default()).expect("flies").outputs();
        assert!(are_finite(&outputs));
        let places: [fn(&mut Outputs) -> &mut f64; 26] = [
            |outputs| &mut outputs.position_m.x,
            |outputs| &mut outputs.velocity_m_s.y,
            |outputs| &mut outputs.acceleration_m_s2.z,
            |outputs| &mut outputs.body_velocity_m_s.x,
            |outputs| &mut outputs.attitude_rad.y,
            |outputs| &mut outputs.quaternion[3],
            |outputs| &mut outputs.body_rate_rad_s.z,
            |outputs| &mut outputs.thrust_n,
            |outputs| &mut outputs.torque_n_m.x,
            |outputs| &mut outputs.rotor_speed_rad_s[2],
            |outputs| &mut outputs.battery.voltage_v,
            |outputs| &mut outputs.battery.current_a,
            |outputs| &mut outputs.battery.remaining,
            |outputs| &mut outputs.tilt_reference_rad[1],
            |outputs| &mut outputs.setpoint.position_m.x,
            |outputs| &mut outputs.setpoint.velocity_m_s.y,
            |outputs| &mut outputs.setpoint.acceleration_m_s2.z,
            |outputs| &mut outputs.setpoint.jerk_m_s3.x,
            |outputs| &mut outputs.setpoint.snap_m_s4.y,
            |outputs| &mut outputs.setpoint.yaw_rad,
            |outputs| &mut outputs.setpoint.yaw_rate_rad_s,
            |outputs| &mut outputs.setpoint.yaw_acceleration_rad_s2,
            |outputs| &mut outputs.tracking_error_m.z,
            |outputs| &mut outputs.yaw_error_rad,
            |outputs| &mut outputs.belief.mass_kg,
            |outputs| &mut outputs.belief.drag_n_s_m.y,
        ];
        for (place, number) in places.into_iter().enumerate() {
            for wrong in [f64::NAN, f64::INFINITY] {
                let mut outputs = outputs;
                *number(&mut outputs) = wrong;
                assert!(!are_finite(&outputs), "{place}");
            }
        }
    }
}
