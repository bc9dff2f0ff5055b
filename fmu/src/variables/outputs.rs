//! The outputs.
//!
//! Outputs at a communication point do not depend on the inputs set there: these act from then on.

use std::f64::consts::{FRAC_PI_2, PI};

use quadrotor::{Choice, ControllerActivity, ControllerStatus as Status, Outputs};

use super::Quantity::{
    Acceleration, Angle, AngularVelocity, Force, Number, Position, RotorSpeed, Torque, Velocity,
};
use super::{Output, Quantity, Role, Signal, Variable};

const fn output(
    name: &'static str,
    quantity: Quantity,
    initially_depends_on: &'static [&'static str],
    get: fn(&Outputs) -> f64,
    description: &'static str,
) -> Variable {
    let signal = Signal::Real { quantity, minimum: None, maximum: None, get };
    Variable { name, description, role: Role::Output(Output { initially_depends_on, signal }) }
}

/// A figure of a controller's last step: known from its first sample on.
const fn figure(name: &'static str, signal: Signal, description: &'static str) -> Variable {
    Variable { name, description, role: Role::Output(Output { initially_depends_on: NOTHING, signal }) }
}

const fn count(name: &'static str, get: fn(&Outputs) -> u32, description: &'static str) -> Variable {
    figure(name, Signal::Count { get }, description)
}

const fn status(name: &'static str, get: fn(&Outputs) -> i32, description: &'static str) -> Variable {
    figure(name, Signal::Enumeration { choice: &STATUS, get }, description)
}

/// What `controller.….status` chooses from.
static STATUS: Choice = Choice {
    name: "ControllerStatus",
    description: "How a controller found its last input",
    items: &[
        ("optimal", "Least cost within all limits"),
        ("relaxed", "No input keeps all limits: least cost and violation together"),
        ("iteration_limit", "The solver ran out of iterations: the last input is held"),
        ("held", "Something was not finite: the last input is held"),
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

impl Variable {
    const fn within(mut self, minimum: f64, maximum: f64) -> Self {
        if let Role::Output(Output { signal: Signal::Real { maximum: most, .. }, .. }) = &mut self.role {
            *most = Some(maximum);
        }
        self.at_least(minimum)
    }

    const fn at_least(mut self, minimum: f64) -> Self {
        if let Role::Output(Output { signal: Signal::Real { minimum: least, .. }, .. }) = &mut self.role {
            *least = Some(minimum);
        }
        self
    }
}

const NOTHING: &[&str] = &[];
const ATTITUDE: &[&str] = &["initial.attitude."];
const BODY_VELOCITY: &[&str] = &["initial.velocity.", "initial.attitude."];
// The rotors begin at hover speed when armed.
const ROTOR_SPEED: &[&str] = &["armed", "airframe.mass", "airframe.rotor.thrust_coefficient"];
const WRENCH: &[&str] = &["armed", "airframe.mass", "airframe.arm_length", "airframe.rotor."];
const ACCELERATION: &[&str] =
    &["armed", "airframe.", "disturbance.force.", "wind.velocity.", "environment.", "initial."];
const TILT_REFERENCE: &[&str] = NOTHING;

#[rustfmt::skip]
pub(super) const OUTPUTS: [Variable; 55] = [
    output("position.x", Position, &["initial.position.x"], |outputs| outputs.position_m.x, "Position north"),
    output("position.y", Position, &["initial.position.y"], |outputs| outputs.position_m.y, "Position east"),
    output("position.z", Position, &["initial.position.z"], |outputs| outputs.position_m.z, "Position down"),
    output("velocity.x", Velocity, &["initial.velocity.x"], |outputs| outputs.velocity_m_s.x, "Velocity north"),
    output("velocity.y", Velocity, &["initial.velocity.y"], |outputs| outputs.velocity_m_s.y, "Velocity east"),
    output("velocity.z", Velocity, &["initial.velocity.z"], |outputs| outputs.velocity_m_s.z, "Velocity down"),
    output("acceleration.x", Acceleration, ACCELERATION, |outputs| outputs.acceleration_m_s2.x, "Acceleration north"),
    output("acceleration.y", Acceleration, ACCELERATION, |outputs| outputs.acceleration_m_s2.y, "Acceleration east"),
    output("acceleration.z", Acceleration, ACCELERATION, |outputs| outputs.acceleration_m_s2.z, "Acceleration down"),
    output("body_velocity.u", Velocity, BODY_VELOCITY, |outputs| outputs.body_velocity_m_s.x, "Velocity forward"),
    output("body_velocity.v", Velocity, BODY_VELOCITY, |outputs| outputs.body_velocity_m_s.y, "Velocity right"),
    output("body_velocity.w", Velocity, BODY_VELOCITY, |outputs| outputs.body_velocity_m_s.z, "Velocity down of the body"),
    output("attitude.phi", Angle, ATTITUDE, |outputs| outputs.attitude_rad.x, "Roll angle (ZYX Euler angles)").within(-PI, PI),
    output("attitude.theta", Angle, ATTITUDE, |outputs| outputs.attitude_rad.y, "Pitch angle (ZYX Euler angles)").within(-FRAC_PI_2, FRAC_PI_2),
    output("attitude.psi", Angle, ATTITUDE, |outputs| outputs.attitude_rad.z, "Heading (ZYX Euler angles)").within(-PI, PI),
    output("attitude.q0", Number, ATTITUDE, |outputs| outputs.quaternion[0], "Attitude quaternion, scalar part: body into north-east-down"),
    output("attitude.q1", Number, ATTITUDE, |outputs| outputs.quaternion[1], "Attitude quaternion, first vector part: body into north-east-down"),
    output("attitude.q2", Number, ATTITUDE, |outputs| outputs.quaternion[2], "Attitude quaternion, second vector part: body into north-east-down"),
    output("attitude.q3", Number, ATTITUDE, |outputs| outputs.quaternion[3], "Attitude quaternion, third vector part: body into north-east-down"),
    output("body_rate.p", AngularVelocity, &["initial.body_rate.p"], |outputs| outputs.body_rate_rad_s.x, "Roll rate"),
    output("body_rate.q", AngularVelocity, &["initial.body_rate.q"], |outputs| outputs.body_rate_rad_s.y, "Pitch rate"),
    output("body_rate.r", AngularVelocity, &["initial.body_rate.r"], |outputs| outputs.body_rate_rad_s.z, "Yaw rate"),
    output("thrust", Force, WRENCH, |outputs| outputs.thrust_n, "Thrust F of the four rotors").at_least(0.0),
    output("torque.phi", Torque, WRENCH, |outputs| outputs.torque_n_m.x, "Torque of the four rotors about the forward axis"),
    output("torque.theta", Torque, WRENCH, |outputs| outputs.torque_n_m.y, "Torque of the four rotors about the right axis"),
    output("torque.psi", Torque, WRENCH, |outputs| outputs.torque_n_m.z, "Torque of the four rotors about the down axis"),
    output("rotor.speed[1]", RotorSpeed, ROTOR_SPEED, |outputs| outputs.rotor_speed_rad_s[0], "Speed of the front rotor").at_least(0.0),
    output("rotor.speed[2]", RotorSpeed, ROTOR_SPEED, |outputs| outputs.rotor_speed_rad_s[1], "Speed of the right rotor").at_least(0.0),
    output("rotor.speed[3]", RotorSpeed, ROTOR_SPEED, |outputs| outputs.rotor_speed_rad_s[2], "Speed of the back rotor").at_least(0.0),
    output("rotor.speed[4]", RotorSpeed, ROTOR_SPEED, |outputs| outputs.rotor_speed_rad_s[3], "Speed of the left rotor").at_least(0.0),
    output("tilt_reference.phi", Angle, TILT_REFERENCE, |outputs| outputs.tilt_reference_rad[0], "Roll angle that the position controller asks for"),
    output("tilt_reference.theta", Angle, TILT_REFERENCE, |outputs| outputs.tilt_reference_rad[1], "Pitch angle that the position controller asks for"),
    output("setpoint.position.x", Position, &["initial.position.x"], |outputs| outputs.setpoint.position_m.x, "Position north that the controllers track, after shaping"),
    output("setpoint.position.y", Position, &["initial.position.y"], |outputs| outputs.setpoint.position_m.y, "Position east that the controllers track, after shaping"),
    output("setpoint.position.z", Position, &["initial.position.z"], |outputs| outputs.setpoint.position_m.z, "Position down that the controllers track, after shaping"),
    output("setpoint.velocity.x", Velocity, NOTHING, |outputs| outputs.setpoint.velocity_m_s.x, "Velocity north that the controllers track, after shaping"),
    output("setpoint.velocity.y", Velocity, NOTHING, |outputs| outputs.setpoint.velocity_m_s.y, "Velocity east that the controllers track, after shaping"),
    output("setpoint.velocity.z", Velocity, NOTHING, |outputs| outputs.setpoint.velocity_m_s.z, "Velocity down that the controllers track, after shaping"),
    output("setpoint.acceleration.x", Acceleration, NOTHING, |outputs| outputs.setpoint.acceleration_m_s2.x, "Acceleration north that the controllers track, after shaping"),
    output("setpoint.acceleration.y", Acceleration, NOTHING, |outputs| outputs.setpoint.acceleration_m_s2.y, "Acceleration east that the controllers track, after shaping"),
    output("setpoint.acceleration.z", Acceleration, NOTHING, |outputs| outputs.setpoint.acceleration_m_s2.z, "Acceleration down that the controllers track, after shaping"),
    output("setpoint.yaw", Angle, ATTITUDE, |outputs| outputs.setpoint.yaw_rad, "Heading that the controllers track, after shaping"),
    output("tracking_error.x", Position, &["initial.position.x"], |outputs| outputs.tracking_error_m.x, "Position minus set-point north"),
    output("tracking_error.y", Position, &["initial.position.y"], |outputs| outputs.tracking_error_m.y, "Position minus set-point east"),
    output("tracking_error.z", Position, &["initial.position.z"], |outputs| outputs.tracking_error_m.z, "Position minus set-point down"),
    output("yaw_error", Angle, ATTITUDE, |outputs| outputs.yaw_error_rad, "Heading minus set-point, the short way round").within(-PI, PI),
    status("controller.altitude.status", |outputs| number(&outputs.activity.altitude), "How the altitude controller found its last input"),
    count("controller.altitude.active_constraints", |outputs| outputs.activity.altitude.active, "Limits that held with equality in the last step of the altitude controller, or cut its input off"),
    count("controller.altitude.iterations", |outputs| outputs.activity.altitude.iterations, "Iterations of the solver in the last step of the altitude controller"),
    status("controller.position.status", |outputs| number(&outputs.activity.position), "How the position controller found its last input"),
    count("controller.position.active_constraints", |outputs| outputs.activity.position.active, "Limits that held with equality in the last step of the position controller, or cut its input off"),
    count("controller.position.iterations", |outputs| outputs.activity.position.iterations, "Iterations of the solver in the last step of the position controller"),
    status("controller.attitude.status", |outputs| number(&outputs.activity.attitude), "How the attitude controller found its last input"),
    count("controller.attitude.active_constraints", |outputs| outputs.activity.attitude.active, "Limits that held with equality in the last step of the attitude controller, or cut its input off"),
    count("controller.attitude.iterations", |outputs| outputs.activity.attitude.iterations, "Iterations of the solver in the last step of the attitude controller"),
];
