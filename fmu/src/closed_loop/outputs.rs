//! The outputs.
//!
//! Outputs at a communication point do not depend on the inputs set there: these act from then on.

use std::f64::consts::{FRAC_PI_2, PI};

use fmi::variables::{Choice, Quantity, Role, Signal, Variable};
use quadrotor::{ControllerActivity, ControllerStatus as Status, Outputs};

use super::ClosedLoop;
use crate::quantities::{
    ACCELERATION, ANGLE, ANGULAR_VELOCITY, CURRENT, FORCE, NUMBER, POSITION, ROTOR_SPEED, TORQUE, VELOCITY,
    VOLTAGE,
};

const fn output(
    name: &'static str,
    quantity: &'static Quantity,
    initially_depends_on: &'static [&'static str],
    get: fn(&Outputs) -> f64,
    description: &'static str,
) -> Variable<ClosedLoop> {
    let signal = Signal::Real { quantity, minimum: None, maximum: None, get };
    Variable::output(name, description, initially_depends_on, signal)
}

/// A figure of a controller's last step: known from its first sample on.
const fn figure(
    name: &'static str,
    signal: Signal<Outputs>,
    description: &'static str,
) -> Variable<ClosedLoop> {
    Variable::output(name, description, NOTHING, signal)
}

const fn count(
    name: &'static str,
    get: fn(&Outputs) -> u32,
    description: &'static str,
) -> Variable<ClosedLoop> {
    figure(name, Signal::Count { get }, description)
}

const fn status(
    name: &'static str,
    get: fn(&Outputs) -> i32,
    description: &'static str,
) -> Variable<ClosedLoop> {
    figure(name, Signal::Enumeration { choice: STATUS, get }, description)
}

/// What `controller.….status` chooses from.
const STATUS: Choice = Choice {
    name: "ControllerStatus",
    description: "Status of a controller's last step",
    items: &[
        ("optimal", "Optimal within all limits"),
        ("relaxed", "No input satisfies all limits: their violation is minimized with the cost"),
        ("iteration_limit", "The solver reached its iteration limit: the previous input is held"),
        ("held", "A value was not finite: the previous input is held"),
    ],
};

fn number(activity: &ControllerActivity) -> i32 {
    match activity.status {
        Status::Optimal => 1,
        Status::Relaxed => 2,
        Status::IterationLimit => 3,
        Status::Held => 4,
    }
}

/// The same output, within [minimum, maximum].
const fn within(mut output: Variable<ClosedLoop>, minimum: f64, maximum: f64) -> Variable<ClosedLoop> {
    if let Role::Output { signal: Signal::Real { maximum: most, .. }, .. } = &mut output.role {
        *most = Some(maximum);
    }
    at_least(output, minimum)
}

/// The same output, not below a minimum.
const fn at_least(mut output: Variable<ClosedLoop>, minimum: f64) -> Variable<ClosedLoop> {
    if let Role::Output { signal: Signal::Real { minimum: least, .. }, .. } = &mut output.role {
        *least = Some(minimum);
    }
    output
}

/// Positive zero, not negative, at the origin.
fn altitude_m(outputs: &Outputs) -> f64 {
    0.0 - outputs.position_m.z
}

const NOTHING: &[&str] = &[];
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
const TILT_REFERENCE: &[&str] = NOTHING;

#[rustfmt::skip]
pub(super) const OUTPUTS: [Variable<ClosedLoop>; 59] = [
    output("position.x", &POSITION, &["initial.position.x"], |outputs| outputs.position_m.x, "Position north"),
    output("position.y", &POSITION, &["initial.position.y"], |outputs| outputs.position_m.y, "Position east"),
    output("position.z", &POSITION, &["initial.position.z"], |outputs| outputs.position_m.z, "Position down"),
    output("altitude", &POSITION, &["initial.position.z"], altitude_m, "Altitude above the origin, positive up: minus position.z"),
    output("velocity.x", &VELOCITY, &["initial.velocity.x"], |outputs| outputs.velocity_m_s.x, "Velocity north"),
    output("velocity.y", &VELOCITY, &["initial.velocity.y"], |outputs| outputs.velocity_m_s.y, "Velocity east"),
    output("velocity.z", &VELOCITY, &["initial.velocity.z"], |outputs| outputs.velocity_m_s.z, "Velocity down"),
    output("acceleration.x", &ACCELERATION, ACCELERATIONS, |outputs| outputs.acceleration_m_s2.x, "Acceleration north"),
    output("acceleration.y", &ACCELERATION, ACCELERATIONS, |outputs| outputs.acceleration_m_s2.y, "Acceleration east"),
    output("acceleration.z", &ACCELERATION, ACCELERATIONS, |outputs| outputs.acceleration_m_s2.z, "Acceleration down"),
    output("body_velocity.u", &VELOCITY, BODY_VELOCITY, |outputs| outputs.body_velocity_m_s.x, "Velocity forward"),
    output("body_velocity.v", &VELOCITY, BODY_VELOCITY, |outputs| outputs.body_velocity_m_s.y, "Velocity right"),
    output("body_velocity.w", &VELOCITY, BODY_VELOCITY, |outputs| outputs.body_velocity_m_s.z, "Velocity down of the body"),
    within(output("attitude.phi", &ANGLE, ATTITUDE, |outputs| outputs.attitude_rad.x, "Roll angle (ZYX Euler angles)"), -PI, PI),
    within(output("attitude.theta", &ANGLE, ATTITUDE, |outputs| outputs.attitude_rad.y, "Pitch angle (ZYX Euler angles)"), -FRAC_PI_2, FRAC_PI_2),
    within(output("attitude.psi", &ANGLE, ATTITUDE, |outputs| outputs.attitude_rad.z, "Heading (ZYX Euler angles)"), -PI, PI),
    output("attitude.q0", &NUMBER, ATTITUDE, |outputs| outputs.quaternion[0], "Attitude quaternion, scalar part: body into north-east-down"),
    output("attitude.q1", &NUMBER, ATTITUDE, |outputs| outputs.quaternion[1], "Attitude quaternion, first vector part: body into north-east-down"),
    output("attitude.q2", &NUMBER, ATTITUDE, |outputs| outputs.quaternion[2], "Attitude quaternion, second vector part: body into north-east-down"),
    output("attitude.q3", &NUMBER, ATTITUDE, |outputs| outputs.quaternion[3], "Attitude quaternion, third vector part: body into north-east-down"),
    output("body_rate.p", &ANGULAR_VELOCITY, &["initial.body_rate.p"], |outputs| outputs.body_rate_rad_s.x, "Roll rate"),
    output("body_rate.q", &ANGULAR_VELOCITY, &["initial.body_rate.q"], |outputs| outputs.body_rate_rad_s.y, "Pitch rate"),
    output("body_rate.r", &ANGULAR_VELOCITY, &["initial.body_rate.r"], |outputs| outputs.body_rate_rad_s.z, "Yaw rate"),
    at_least(output("thrust", &FORCE, WRENCH, |outputs| outputs.thrust_n, "Thrust F of the four rotors"), 0.0),
    output("torque.phi", &TORQUE, WRENCH, |outputs| outputs.torque_n_m.x, "Torque of the four rotors about the forward axis"),
    output("torque.theta", &TORQUE, WRENCH, |outputs| outputs.torque_n_m.y, "Torque of the four rotors about the right axis"),
    output("torque.psi", &TORQUE, WRENCH, |outputs| outputs.torque_n_m.z, "Torque of the four rotors about the down axis"),
    at_least(output("rotor.speed[1]", &ROTOR_SPEED, ROTOR_SPEEDS, |outputs| outputs.rotor_speed_rad_s[0], "Speed of the front rotor"), 0.0),
    at_least(output("rotor.speed[2]", &ROTOR_SPEED, ROTOR_SPEEDS, |outputs| outputs.rotor_speed_rad_s[1], "Speed of the right rotor"), 0.0),
    at_least(output("rotor.speed[3]", &ROTOR_SPEED, ROTOR_SPEEDS, |outputs| outputs.rotor_speed_rad_s[2], "Speed of the back rotor"), 0.0),
    at_least(output("rotor.speed[4]", &ROTOR_SPEED, ROTOR_SPEEDS, |outputs| outputs.rotor_speed_rad_s[3], "Speed of the left rotor"), 0.0),
    at_least(output("battery.voltage", &VOLTAGE, BATTERY, |outputs| outputs.battery.voltage_v, "Voltage of the battery"), 0.0),
    at_least(output("battery.current", &CURRENT, BATTERY, |outputs| outputs.battery.current_a, "Current from the battery to the motors"), 0.0),
    within(output("battery.remaining", &NUMBER, BATTERY, |outputs| outputs.battery.remaining, "Remaining share of the battery's charge; 1 without airframe.battery.sag"), 0.0, 1.0),
    output("tilt_reference.phi", &ANGLE, TILT_REFERENCE, |outputs| outputs.tilt_reference_rad[0], "Roll angle commanded by the position controller"),
    output("tilt_reference.theta", &ANGLE, TILT_REFERENCE, |outputs| outputs.tilt_reference_rad[1], "Pitch angle commanded by the position controller"),
    output("setpoint.position.x", &POSITION, &["armed", "reference.position.x", "reference.shaping", "initial.position.x"], |outputs| outputs.setpoint.position_m.x, "Position set-point north, after shaping"),
    output("setpoint.position.y", &POSITION, &["armed", "reference.position.y", "reference.shaping", "initial.position.y"], |outputs| outputs.setpoint.position_m.y, "Position set-point east, after shaping"),
    output("setpoint.position.z", &POSITION, &["armed", "reference.position.z", "reference.shaping", "initial.position.z"], |outputs| outputs.setpoint.position_m.z, "Position set-point down, after shaping"),
    output("setpoint.velocity.x", &VELOCITY, &["armed", "reference.velocity.x", "reference.shaping"], |outputs| outputs.setpoint.velocity_m_s.x, "Velocity set-point north, after shaping"),
    output("setpoint.velocity.y", &VELOCITY, &["armed", "reference.velocity.y", "reference.shaping"], |outputs| outputs.setpoint.velocity_m_s.y, "Velocity set-point east, after shaping"),
    output("setpoint.velocity.z", &VELOCITY, &["armed", "reference.velocity.z", "reference.shaping"], |outputs| outputs.setpoint.velocity_m_s.z, "Velocity set-point down, after shaping"),
    output("setpoint.acceleration.x", &ACCELERATION, &["armed", "reference.acceleration.x", "reference.shaping"], |outputs| outputs.setpoint.acceleration_m_s2.x, "Acceleration set-point north, after shaping"),
    output("setpoint.acceleration.y", &ACCELERATION, &["armed", "reference.acceleration.y", "reference.shaping"], |outputs| outputs.setpoint.acceleration_m_s2.y, "Acceleration set-point east, after shaping"),
    output("setpoint.acceleration.z", &ACCELERATION, &["armed", "reference.acceleration.z", "reference.shaping"], |outputs| outputs.setpoint.acceleration_m_s2.z, "Acceleration set-point down, after shaping"),
    output("setpoint.yaw", &ANGLE, ATTITUDE, |outputs| outputs.setpoint.yaw_rad, "Heading set-point, after shaping"),
    output("tracking_error.x", &POSITION, &["armed", "reference.position.x", "reference.shaping", "initial.position.x"], |outputs| outputs.tracking_error_m.x, "Position minus set-point north"),
    output("tracking_error.y", &POSITION, &["armed", "reference.position.y", "reference.shaping", "initial.position.y"], |outputs| outputs.tracking_error_m.y, "Position minus set-point east"),
    output("tracking_error.z", &POSITION, &["armed", "reference.position.z", "reference.shaping", "initial.position.z"], |outputs| outputs.tracking_error_m.z, "Position minus set-point down"),
    within(output("yaw_error", &ANGLE, ATTITUDE, |outputs| outputs.yaw_error_rad, "Heading minus set-point, wrapped to [-pi, pi]"), -PI, PI),
    status("controller.altitude.status", |outputs| number(&outputs.activity.altitude), "Status of the altitude controller's last step"),
    count("controller.altitude.active_constraints", |outputs| outputs.activity.altitude.active, "Number of limits that were active in the altitude controller's last step, or clipped its input"),
    count("controller.altitude.iterations", |outputs| outputs.activity.altitude.iterations, "Solver iterations in the altitude controller's last step"),
    status("controller.position.status", |outputs| number(&outputs.activity.position), "Status of the position controller's last step"),
    count("controller.position.active_constraints", |outputs| outputs.activity.position.active, "Number of limits that were active in the position controller's last step, or clipped its input"),
    count("controller.position.iterations", |outputs| outputs.activity.position.iterations, "Solver iterations in the position controller's last step"),
    status("controller.attitude.status", |outputs| number(&outputs.activity.attitude), "Status of the attitude controller's last step"),
    count("controller.attitude.active_constraints", |outputs| outputs.activity.attitude.active, "Number of limits that were active in the attitude controller's last step, or clipped its input"),
    count("controller.attitude.iterations", |outputs| outputs.activity.attitude.iterations, "Solver iterations in the attitude controller's last step"),
];
