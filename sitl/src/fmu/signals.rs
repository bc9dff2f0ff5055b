//! What goes to an FMU and what comes from it, by our names.

use importer::description::Dimension;

const LENGTH: Dimension = Dimension([0, 1, 0, 0, 0, 0, 0]);
const VELOCITY: Dimension = Dimension([0, 1, -1, 0, 0, 0, 0]);
const ACCELERATION: Dimension = Dimension([0, 1, -2, 0, 0, 0, 0]);
const NUMBER: Dimension = Dimension([0; 7]);
const RATE: Dimension = Dimension([0, 0, -1, 0, 0, 0, 0]);
const FORCE: Dimension = Dimension([1, 1, -2, 0, 0, 0, 0]);
const TORQUE: Dimension = Dimension([1, 2, -2, 0, 0, 0, 0]);

/// Signals that are mapped all together, or not at all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Group {
    /// Beginning of their names.
    pub name: &'static str,
    /// Their names after a dot; none if the group's name is the signal's.
    pub parts: &'static [&'static str],
    /// What they measure, and the SI unit that they have here.
    pub dimension: Dimension,
    /// The unit, for a person.
    pub unit: &'static str,
    /// Beginnings of variables' names that are taken without a map, and what their parts are called.
    pub defaults: &'static [(&'static str, [&'static str; 4])],
    /// What they are, for a person.
    pub description: &'static str,
}

const fn group(
    name: &'static str,
    parts: &'static [&'static str],
    (dimension, unit): (Dimension, &'static str),
    defaults: &'static [(&'static str, [&'static str; 4])],
    description: &'static str,
) -> Group {
    Group { name, parts, dimension, unit, defaults, description }
}

const XYZ: &[&str] = &["x", "y", "z"];
const FOUR: &[&str] = &["1", "2", "3", "4"];
const DOTTED: [&str; 4] = [".x", ".y", ".z", ""];
const NUMBERED: [&str; 4] = [".1", ".2", ".3", ".4"];
const INDEXED: [&str; 4] = ["[1]", "[2]", "[3]", "[4]"];
const ALONE: [&str; 4] = ["", "", "", ""];

const METRE: (Dimension, &str) = (LENGTH, "m");
const METRE_PER_SECOND: (Dimension, &str) = (VELOCITY, "m/s");
const METRE_PER_SECOND_SQUARED: (Dimension, &str) = (ACCELERATION, "m/s2");
const RADIAN: (Dimension, &str) = (NUMBER, "rad");
const ONE: (Dimension, &str) = (NUMBER, "1");
const RADIAN_PER_SECOND: (Dimension, &str) = (RATE, "rad/s");
const NEWTON: (Dimension, &str) = (FORCE, "N");
const NEWTON_METRE: (Dimension, &str) = (TORQUE, "N.m");

/// Real inputs, in the order in which [`Demand`](vehicle::foreign::Demand) is written into them.
#[rustfmt::skip]
pub const INPUTS: [Group; 10] = [
    group("reference.position", XYZ, METRE, &[("reference.position", DOTTED)], "where to be, along the world's axes"),
    group("reference.velocity", XYZ, METRE_PER_SECOND, &[("reference.velocity", DOTTED)], "velocity of the reference"),
    group("reference.acceleration", XYZ, METRE_PER_SECOND_SQUARED, &[("reference.acceleration", DOTTED)], "acceleration of the reference"),
    group("reference.yaw", &[], RADIAN, &[("reference.yaw", ALONE)], "heading about the world's z axis; it goes on over a whole turn"),
    group("reference.yaw_rate", &[], RADIAN_PER_SECOND, &[("reference.yaw_rate", ALONE)], "rate of the heading"),
    group("rotor.command", FOUR, RADIAN_PER_SECOND, &[("rotor.command", INDEXED), ("rotor.command", NUMBERED), ("rotor.speed_command", INDEXED)], "speeds that the rotors are to turn with, in the order of the airframe's layout"),
    group("thrust", &[], NEWTON, &[("thrust", ALONE), ("command.thrust", ALONE)], "thrust of all rotors, along the body's z axis away from the ground"),
    group("torque", XYZ, NEWTON_METRE, &[("torque", DOTTED), ("torque", [".phi", ".theta", ".psi", ""]), ("command.torque", [".phi", ".theta", ".psi", ""])], "torques of all rotors about the body's axes"),
    group("wind.velocity", XYZ, METRE_PER_SECOND, &[("wind.velocity", DOTTED)], "velocity of the air, along the world's axes"),
    group("ground.z", &[], METRE, &[("ground.z", ALONE)], "z of the ground below the vehicle, along the world's z axis"),
];

/// Indices into [`INPUTS`].
pub mod input {
    /// Reference position.
    pub const REFERENCE_POSITION: usize = 0;
    /// Reference velocity.
    pub const REFERENCE_VELOCITY: usize = 1;
    /// Reference acceleration.
    pub const REFERENCE_ACCELERATION: usize = 2;
    /// Reference yaw.
    pub const REFERENCE_YAW: usize = 3;
    /// Reference yaw rate.
    pub const REFERENCE_YAW_RATE: usize = 4;
    /// Rotor command.
    pub const ROTOR_COMMAND: usize = 5;
    /// Thrust.
    pub const THRUST: usize = 6;
    /// Torque.
    pub const TORQUE: usize = 7;
    /// Wind.
    pub const WIND: usize = 8;
    /// Height of the ground.
    pub const GROUND: usize = 9;
}

/// The Boolean input.
pub const ARMED: &str = "armed";

/// Real outputs.
#[rustfmt::skip]
pub const OUTPUTS: [Group; 9] = [
    group("position", XYZ, METRE, &[("position", DOTTED)], "place of the vehicle, along the world's axes"),
    group("velocity", XYZ, METRE_PER_SECOND, &[("velocity", DOTTED)], "velocity along the world's axes; or body_velocity"),
    group("body_velocity", &["u", "v", "w"], METRE_PER_SECOND, &[("body_velocity", [".u", ".v", ".w", ""])], "velocity along the body's axes, in place of velocity"),
    group("quaternion", &["w", "x", "y", "z"], ONE, &[("attitude", [".q0", ".q1", ".q2", ".q3"]), ("quaternion", [".w", ".x", ".y", ".z"])], "attitude: body into world, scalar part first; or attitude"),
    group("attitude", &["phi", "theta", "psi"], RADIAN, &[("attitude", [".phi", ".theta", ".psi", ""])], "roll, pitch and yaw (ZYX Euler angles), in place of quaternion"),
    group("body_rate", &["p", "q", "r"], RADIAN_PER_SECOND, &[("body_rate", [".p", ".q", ".r", ""])], "angular velocity about the body's axes"),
    group("acceleration", XYZ, METRE_PER_SECOND_SQUARED, &[("acceleration", DOTTED)], "acceleration along the world's axes; else the change of velocity"),
    group("rotor.speed", FOUR, RADIAN_PER_SECOND, &[("rotor.speed", INDEXED), ("rotor.speed", NUMBERED)], "speeds of the rotors; else the airframe's lag behind the commands"),
    group("rotor.thrust", &[], NEWTON, &[("rotor.thrust", ALONE), ("thrust", ALONE)], "thrust of all rotors; else from their speeds"),
];

/// Indices into [`OUTPUTS`].
pub mod output {
    /// Position.
    pub const POSITION: usize = 0;
    /// Velocity.
    pub const VELOCITY: usize = 1;
    /// Body velocity.
    pub const BODY_VELOCITY: usize = 2;
    /// Quaternion.
    pub const QUATERNION: usize = 3;
    /// Attitude.
    pub const ATTITUDE: usize = 4;
    /// Body rate.
    pub const BODY_RATE: usize = 5;
    /// Acceleration.
    pub const ACCELERATION: usize = 6;
    /// Rotor speed.
    pub const ROTOR_SPEED: usize = 7;
    /// Rotor thrust.
    pub const ROTOR_THRUST: usize = 8;
}

impl Group {
    /// How many signals it has.
    pub fn count(&self) -> usize {
        self.parts.len().max(1)
    }

    /// The name of one of them.
    pub fn signal(&self, part: usize) -> String {
        match self.parts.get(part) {
            Some(part) => format!("{}.{part}", self.name),
            None => self.name.to_owned(),
        }
    }

    /// Their names.
    pub fn signals(&self) -> impl Iterator<Item = String> + '_ {
        (0..self.count()).map(|part| self.signal(part))
    }
}

/// The names of all signals.
pub fn names() -> impl Iterator<Item = String> {
    INPUTS.iter().chain(&OUTPUTS).flat_map(Group::signals).chain([ARMED.to_owned()])
}
