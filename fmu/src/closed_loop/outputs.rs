//! The outputs.
//!
//! Outputs at a communication point do not depend on the inputs set there: these act from then on.

use std::f64::consts::{FRAC_PI_2, PI};

use fmi::variables::Variable;
use quadrotor::Outputs;

use super::ClosedLoop;
use crate::quantities::{
    ACCELERATION, ANGLE, ANGULAR_VELOCITY, CURRENT, FORCE, NUMBER, POSITION, ROTOR_SPEED, TORQUE, VELOCITY,
    VOLTAGE,
};
use crate::tables::rows::{at_least, output, within};
use crate::tables::steering;

/// Positive zero, not negative, at the origin.
fn altitude_m(outputs: &Outputs) -> f64 {
    0.0 - outputs.position_m.z
}

const ATTITUDE: &[&str] = &["initial.attitude."];
const BODY_VELOCITY: &[&str] = &["initial.velocity.", "initial.attitude."];
// The rotors begin at hover speed when armed.
const ROTOR_SPEEDS: &[&str] =
    &["armed", "airframe.preset", "airframe.mass", "airframe.rotor.thrust_coefficient"];
// Of rotors in moving air, and close to the ground.
const WRENCH: &[&str] = &["armed", "airframe.", "wind.velocity.", "environment.", "initial."];
const BATTERY: &[&str] = &[
    "armed",
    "airframe.preset",
    "airframe.mass",
    "airframe.rotor.",
    "airframe.battery.",
    "initial.discharge",
];
const ACCELERATIONS: &[&str] =
    &["armed", "airframe.", "disturbance.force.", "wind.velocity.", "environment.", "initial."];

/// The motion of the vehicle, its rotors and its battery.
#[rustfmt::skip]
pub(super) const MOTION: [Variable<ClosedLoop>; 34] = [
    output("position.x", &POSITION, &["initial.position.x"], |outputs: &Outputs| outputs.position_m.x, "Position north"),
    output("position.y", &POSITION, &["initial.position.y"], |outputs: &Outputs| outputs.position_m.y, "Position east"),
    output("position.z", &POSITION, &["initial.position.z"], |outputs: &Outputs| outputs.position_m.z, "Position down"),
    output("altitude", &POSITION, &["initial.position.z"], altitude_m, "Altitude above the origin, positive up: minus position.z"),
    output("velocity.x", &VELOCITY, &["initial.velocity.x"], |outputs: &Outputs| outputs.velocity_m_s.x, "Velocity north"),
    output("velocity.y", &VELOCITY, &["initial.velocity.y"], |outputs: &Outputs| outputs.velocity_m_s.y, "Velocity east"),
    output("velocity.z", &VELOCITY, &["initial.velocity.z"], |outputs: &Outputs| outputs.velocity_m_s.z, "Velocity down"),
    output("acceleration.x", &ACCELERATION, ACCELERATIONS, |outputs: &Outputs| outputs.acceleration_m_s2.x, "Acceleration north"),
    output("acceleration.y", &ACCELERATION, ACCELERATIONS, |outputs: &Outputs| outputs.acceleration_m_s2.y, "Acceleration east"),
    output("acceleration.z", &ACCELERATION, ACCELERATIONS, |outputs: &Outputs| outputs.acceleration_m_s2.z, "Acceleration down"),
    output("body_velocity.u", &VELOCITY, BODY_VELOCITY, |outputs: &Outputs| outputs.body_velocity_m_s.x, "Velocity forward"),
    output("body_velocity.v", &VELOCITY, BODY_VELOCITY, |outputs: &Outputs| outputs.body_velocity_m_s.y, "Velocity right"),
    output("body_velocity.w", &VELOCITY, BODY_VELOCITY, |outputs: &Outputs| outputs.body_velocity_m_s.z, "Velocity down of the body"),
    within(output("attitude.phi", &ANGLE, ATTITUDE, |outputs: &Outputs| outputs.attitude_rad.x, "Roll angle (ZYX Euler angles)"), -PI, PI),
    within(output("attitude.theta", &ANGLE, ATTITUDE, |outputs: &Outputs| outputs.attitude_rad.y, "Pitch angle (ZYX Euler angles)"), -FRAC_PI_2, FRAC_PI_2),
    within(output("attitude.psi", &ANGLE, ATTITUDE, |outputs: &Outputs| outputs.attitude_rad.z, "Heading (ZYX Euler angles)"), -PI, PI),
    output("attitude.q0", &NUMBER, ATTITUDE, |outputs: &Outputs| outputs.quaternion[0], "Attitude quaternion, scalar part: body into north-east-down"),
    output("attitude.q1", &NUMBER, ATTITUDE, |outputs: &Outputs| outputs.quaternion[1], "Attitude quaternion, first vector part: body into north-east-down"),
    output("attitude.q2", &NUMBER, ATTITUDE, |outputs: &Outputs| outputs.quaternion[2], "Attitude quaternion, second vector part: body into north-east-down"),
    output("attitude.q3", &NUMBER, ATTITUDE, |outputs: &Outputs| outputs.quaternion[3], "Attitude quaternion, third vector part: body into north-east-down"),
    output("body_rate.p", &ANGULAR_VELOCITY, &["initial.body_rate.p"], |outputs: &Outputs| outputs.body_rate_rad_s.x, "Roll rate"),
    output("body_rate.q", &ANGULAR_VELOCITY, &["initial.body_rate.q"], |outputs: &Outputs| outputs.body_rate_rad_s.y, "Pitch rate"),
    output("body_rate.r", &ANGULAR_VELOCITY, &["initial.body_rate.r"], |outputs: &Outputs| outputs.body_rate_rad_s.z, "Yaw rate"),
    at_least(output("thrust", &FORCE, WRENCH, |outputs: &Outputs| outputs.thrust_n, "Thrust F of the four rotors"), 0.0),
    output("torque.phi", &TORQUE, WRENCH, |outputs: &Outputs| outputs.torque_n_m.x, "Torque of the four rotors about the forward axis"),
    output("torque.theta", &TORQUE, WRENCH, |outputs: &Outputs| outputs.torque_n_m.y, "Torque of the four rotors about the right axis"),
    output("torque.psi", &TORQUE, WRENCH, |outputs: &Outputs| outputs.torque_n_m.z, "Torque of the four rotors about the down axis"),
    at_least(output("rotor.speed[1]", &ROTOR_SPEED, ROTOR_SPEEDS, |outputs: &Outputs| outputs.rotor_speed_rad_s[0], "Speed of the front rotor"), 0.0),
    at_least(output("rotor.speed[2]", &ROTOR_SPEED, ROTOR_SPEEDS, |outputs: &Outputs| outputs.rotor_speed_rad_s[1], "Speed of the right rotor"), 0.0),
    at_least(output("rotor.speed[3]", &ROTOR_SPEED, ROTOR_SPEEDS, |outputs: &Outputs| outputs.rotor_speed_rad_s[2], "Speed of the back rotor"), 0.0),
    at_least(output("rotor.speed[4]", &ROTOR_SPEED, ROTOR_SPEEDS, |outputs: &Outputs| outputs.rotor_speed_rad_s[3], "Speed of the left rotor"), 0.0),
    at_least(output("battery.voltage", &VOLTAGE, BATTERY, |outputs: &Outputs| outputs.battery.voltage_v, "Voltage of the battery"), 0.0),
    at_least(output("battery.current", &CURRENT, BATTERY, |outputs: &Outputs| outputs.battery.current_a, "Current from the battery to the motors"), 0.0),
    within(output("battery.remaining", &NUMBER, BATTERY, |outputs: &Outputs| outputs.battery.remaining, "Remaining share of the battery's charge; 1 without airframe.battery.sag"), 0.0, 1.0),
];

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
pub(super) const ACTIVITY: [Variable<ClosedLoop>; 9] = steering::activity();
