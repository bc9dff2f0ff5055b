//! The outputs.
//!
//! Outputs at a communication point do not depend on the inputs set there: these act from then on.

use fmi::array;
use fmi::variables::{Array, Variable};
use quadrotor::{Activity, Belief, PositionReference};

use super::{Controller, ControllerOutputs};
use crate::quantities::{FORCE, ROTOR_SPEED, TORQUE};
use crate::tables::rows::{at_least, output};
use crate::tables::steering::{self, Steered};

impl Steered for ControllerOutputs {
    fn tilt_reference_rad(&self) -> [f64; 2] {
        self.tilt_reference_rad
    }

    fn setpoint(&self) -> &PositionReference {
        &self.setpoint
    }

    fn activity(&self) -> &Activity {
        &self.activity
    }

    fn belief(&self) -> &Belief {
        &self.belief
    }
}

// Before the first sample the speeds that the rotors have are held.
const ROTORS: &[&str] = &[
    "armed",
    "measured.rotor.",
    "measurement.rotor_speeds",
    "airframe.preset",
    "airframe.mass",
    "airframe.rotor.thrust_coefficient",
];
const WRENCH: &[&str] = &["armed", "measured.rotor.", "measurement.rotor_speeds", "airframe."];

/// What is commanded.
#[rustfmt::skip]
pub(super) const COMMANDS: [Variable<Controller>; 8] = [
    at_least(output("rotor.command[1]", &ROTOR_SPEED, ROTORS, |outputs: &ControllerOutputs| outputs.rotor_command_rad_s[0], "Commanded speed of the front rotor"), 0.0),
    at_least(output("rotor.command[2]", &ROTOR_SPEED, ROTORS, |outputs: &ControllerOutputs| outputs.rotor_command_rad_s[1], "Commanded speed of the right rotor"), 0.0),
    at_least(output("rotor.command[3]", &ROTOR_SPEED, ROTORS, |outputs: &ControllerOutputs| outputs.rotor_command_rad_s[2], "Commanded speed of the back rotor"), 0.0),
    at_least(output("rotor.command[4]", &ROTOR_SPEED, ROTORS, |outputs: &ControllerOutputs| outputs.rotor_command_rad_s[3], "Commanded speed of the left rotor"), 0.0),
    at_least(output("command.thrust", &FORCE, WRENCH, |outputs: &ControllerOutputs| outputs.wrench.thrust_n, "Commanded thrust of the four rotors, after allocation and limits: the thrust answers to it with the rotors' first-order lag"), 0.0),
    output("command.torque.phi", &TORQUE, WRENCH, |outputs: &ControllerOutputs| outputs.wrench.torque_n_m.x, "Commanded torque about the forward axis, after allocation and limits"),
    output("command.torque.theta", &TORQUE, WRENCH, |outputs: &ControllerOutputs| outputs.wrench.torque_n_m.y, "Commanded torque about the right axis, after allocation and limits"),
    output("command.torque.psi", &TORQUE, WRENCH, |outputs: &ControllerOutputs| outputs.wrench.torque_n_m.z, "Commanded torque about the down axis, after allocation and limits"),
];

/// What the controllers steer by.
pub(super) const STEERING: [Variable<Controller>; 12] = steering::set_points();

/// How the controllers came to their last inputs.
pub(super) const ACTIVITY: [Variable<Controller>; 12] = steering::activity();

/// What the controllers take the vehicle for.
pub(super) const BELIEF: [Variable<Controller>; 4] = steering::belief();

/// What is commanded, as vectors.
#[rustfmt::skip]
pub(super) const ARRAYS: &[Array] = &[
    array!("rotor.command", ["[1]", "[2]", "[3]", "[4]"], "Commanded speeds of the front, right, back and left rotor"),
    array!("command.torque", [".phi", ".theta", ".psi"], "Commanded torque about the forward, right and down axes, after allocation and limits"),
];
