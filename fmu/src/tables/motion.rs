//! What can be seen of the vehicle.

use std::f64::consts::{FRAC_PI_2, PI};

use fmi::Model;
use fmi::variables::Variable;
use nalgebra::Vector3;
use quadrotor::{BatteryOutput, Outputs};

use super::rows::{at_least, output, within};
use crate::quantities::{
    ACCELERATION, ANGLE, ANGULAR_VELOCITY, CURRENT, FORCE, NUMBER, POSITION, ROTOR_SPEED, TORQUE, VELOCITY,
    VOLTAGE,
};

/// Outputs with those of a vehicle among them.
pub(crate) trait Moving {
    /// x, y, z in NED, m.
    fn position_m(&self) -> Vector3<f64>;
    /// Velocity in NED, m/s.
    fn velocity_m_s(&self) -> Vector3<f64>;
    /// Acceleration in NED, m/s².
    fn acceleration_m_s2(&self) -> Vector3<f64>;
    /// u, v, w in FRD, m/s.
    fn body_velocity_m_s(&self) -> Vector3<f64>;
    /// φ, θ, ψ, rad.
    fn attitude_rad(&self) -> Vector3<f64>;
    /// q₀ … q₃, FRD into NED.
    fn quaternion(&self) -> [f64; 4];
    /// p, q, r, rad/s.
    fn body_rate_rad_s(&self) -> Vector3<f64>;
    /// F, N.
    fn thrust_n(&self) -> f64;
    /// τ_φ, τ_θ, τ_ψ, N·m.
    fn torque_n_m(&self) -> Vector3<f64>;
    /// Speeds of the rotors, rad/s.
    fn rotor_speed_rad_s(&self) -> [f64; 4];
    /// What the battery gives.
    fn battery(&self) -> BatteryOutput;
}

impl Moving for Outputs {
    fn position_m(&self) -> Vector3<f64> {
        self.position_m
    }

    fn velocity_m_s(&self) -> Vector3<f64> {
        self.velocity_m_s
    }

    fn acceleration_m_s2(&self) -> Vector3<f64> {
        self.acceleration_m_s2
    }

    fn body_velocity_m_s(&self) -> Vector3<f64> {
        self.body_velocity_m_s
    }

    fn attitude_rad(&self) -> Vector3<f64> {
        self.attitude_rad
    }

    fn quaternion(&self) -> [f64; 4] {
        self.quaternion
    }

    fn body_rate_rad_s(&self) -> Vector3<f64> {
        self.body_rate_rad_s
    }

    fn thrust_n(&self) -> f64 {
        self.thrust_n
    }

    fn torque_n_m(&self) -> Vector3<f64> {
        self.torque_n_m
    }

    fn rotor_speed_rad_s(&self) -> [f64; 4] {
        self.rotor_speed_rad_s
    }

    fn battery(&self) -> BatteryOutput {
        self.battery
    }
}

const ATTITUDE: &[&str] = &["initial.attitude."];
const BODY_VELOCITY: &[&str] = &["initial.velocity.", "initial.attitude."];
// A name that a model does not have stands for nothing.
// Armed, the rotors begin at speeds that carry the weight and balance it.
const ROTOR_SPEEDS: &[&str] = &[
    "armed",
    "actuation",
    "initial.hovering",
    "airframe.preset",
    "airframe.mass",
    "airframe.arm_length",
    "airframe.centre_of_gravity.",
    "airframe.rotor.thrust_coefficient",
    "airframe.rotor.speed_max",
];
// Of rotors in moving air, and close to the ground.
const WRENCH: &[&str] = &[
    "armed",
    "actuation",
    "command.",
    "airframe.",
    "wind.velocity.",
    "ground.z",
    "environment.",
    "initial.",
];
const BATTERY: &[&str] = &[
    "armed",
    "actuation",
    "initial.hovering",
    "airframe.preset",
    "airframe.mass",
    "airframe.arm_length",
    "airframe.centre_of_gravity.",
    "airframe.rotor.",
    "airframe.battery.",
    "initial.discharge",
];
const ACCELERATIONS: &[&str] = &[
    "armed",
    "actuation",
    "command.thrust",
    "airframe.",
    "disturbance.force.",
    "wind.velocity.",
    "ground.z",
    "environment.",
    "initial.",
];

/// The motion of the vehicle, its rotors and its battery.
#[rustfmt::skip]
pub(crate) const fn motion<M: Model<Outputs: Moving>>() -> [Variable<M>; 34] {
    [
        output("position.x", &POSITION, &["initial.position.x"], |outputs: &M::Outputs| outputs.position_m().x, "Position north"),
        output("position.y", &POSITION, &["initial.position.y"], |outputs: &M::Outputs| outputs.position_m().y, "Position east"),
        output("position.z", &POSITION, &["initial.position.z"], |outputs: &M::Outputs| outputs.position_m().z, "Position down"),
        output("altitude", &POSITION, &["initial.position.z"], |outputs: &M::Outputs| 0.0 - outputs.position_m().z, "Altitude above the origin, positive up: minus position.z"),
        output("velocity.x", &VELOCITY, &["initial.velocity.x"], |outputs: &M::Outputs| outputs.velocity_m_s().x, "Velocity north"),
        output("velocity.y", &VELOCITY, &["initial.velocity.y"], |outputs: &M::Outputs| outputs.velocity_m_s().y, "Velocity east"),
        output("velocity.z", &VELOCITY, &["initial.velocity.z"], |outputs: &M::Outputs| outputs.velocity_m_s().z, "Velocity down"),
        output("acceleration.x", &ACCELERATION, ACCELERATIONS, |outputs: &M::Outputs| outputs.acceleration_m_s2().x, "Acceleration north"),
        output("acceleration.y", &ACCELERATION, ACCELERATIONS, |outputs: &M::Outputs| outputs.acceleration_m_s2().y, "Acceleration east"),
        output("acceleration.z", &ACCELERATION, ACCELERATIONS, |outputs: &M::Outputs| outputs.acceleration_m_s2().z, "Acceleration down"),
        output("body_velocity.u", &VELOCITY, BODY_VELOCITY, |outputs: &M::Outputs| outputs.body_velocity_m_s().x, "Velocity forward"),
        output("body_velocity.v", &VELOCITY, BODY_VELOCITY, |outputs: &M::Outputs| outputs.body_velocity_m_s().y, "Velocity right"),
        output("body_velocity.w", &VELOCITY, BODY_VELOCITY, |outputs: &M::Outputs| outputs.body_velocity_m_s().z, "Velocity down of the body"),
        within(output("attitude.phi", &ANGLE, ATTITUDE, |outputs: &M::Outputs| outputs.attitude_rad().x, "Roll angle (ZYX Euler angles)"), -PI, PI),
        within(output("attitude.theta", &ANGLE, ATTITUDE, |outputs: &M::Outputs| outputs.attitude_rad().y, "Pitch angle (ZYX Euler angles)"), -FRAC_PI_2, FRAC_PI_2),
        within(output("attitude.psi", &ANGLE, ATTITUDE, |outputs: &M::Outputs| outputs.attitude_rad().z, "Heading (ZYX Euler angles)"), -PI, PI),
        output("attitude.q0", &NUMBER, ATTITUDE, |outputs: &M::Outputs| outputs.quaternion()[0], "Attitude quaternion, scalar part: body into north-east-down"),
        output("attitude.q1", &NUMBER, ATTITUDE, |outputs: &M::Outputs| outputs.quaternion()[1], "Attitude quaternion, first vector part: body into north-east-down"),
        output("attitude.q2", &NUMBER, ATTITUDE, |outputs: &M::Outputs| outputs.quaternion()[2], "Attitude quaternion, second vector part: body into north-east-down"),
        output("attitude.q3", &NUMBER, ATTITUDE, |outputs: &M::Outputs| outputs.quaternion()[3], "Attitude quaternion, third vector part: body into north-east-down"),
        output("body_rate.p", &ANGULAR_VELOCITY, &["initial.body_rate.p"], |outputs: &M::Outputs| outputs.body_rate_rad_s().x, "Roll rate"),
        output("body_rate.q", &ANGULAR_VELOCITY, &["initial.body_rate.q"], |outputs: &M::Outputs| outputs.body_rate_rad_s().y, "Pitch rate"),
        output("body_rate.r", &ANGULAR_VELOCITY, &["initial.body_rate.r"], |outputs: &M::Outputs| outputs.body_rate_rad_s().z, "Yaw rate"),
        at_least(output("thrust", &FORCE, WRENCH, |outputs: &M::Outputs| outputs.thrust_n(), "Thrust F of the four rotors"), 0.0),
        output("torque.phi", &TORQUE, WRENCH, |outputs: &M::Outputs| outputs.torque_n_m().x, "Torque of the four rotors about the forward axis"),
        output("torque.theta", &TORQUE, WRENCH, |outputs: &M::Outputs| outputs.torque_n_m().y, "Torque of the four rotors about the right axis"),
        output("torque.psi", &TORQUE, WRENCH, |outputs: &M::Outputs| outputs.torque_n_m().z, "Torque of the four rotors about the down axis"),
        at_least(output("rotor.speed[1]", &ROTOR_SPEED, ROTOR_SPEEDS, |outputs: &M::Outputs| outputs.rotor_speed_rad_s()[0], "Speed of the front rotor"), 0.0),
        at_least(output("rotor.speed[2]", &ROTOR_SPEED, ROTOR_SPEEDS, |outputs: &M::Outputs| outputs.rotor_speed_rad_s()[1], "Speed of the right rotor"), 0.0),
        at_least(output("rotor.speed[3]", &ROTOR_SPEED, ROTOR_SPEEDS, |outputs: &M::Outputs| outputs.rotor_speed_rad_s()[2], "Speed of the back rotor"), 0.0),
        at_least(output("rotor.speed[4]", &ROTOR_SPEED, ROTOR_SPEEDS, |outputs: &M::Outputs| outputs.rotor_speed_rad_s()[3], "Speed of the left rotor"), 0.0),
        at_least(output("battery.voltage", &VOLTAGE, BATTERY, |outputs: &M::Outputs| outputs.battery().voltage_v, "Voltage of the battery"), 0.0),
        at_least(output("battery.current", &CURRENT, BATTERY, |outputs: &M::Outputs| outputs.battery().current_a, "Current from the battery to the motors"), 0.0),
        within(output("battery.remaining", &NUMBER, BATTERY, |outputs: &M::Outputs| outputs.battery().remaining, "Remaining share of the battery's charge; 1 without airframe.battery.sag"), 0.0, 1.0),
    ]
}
