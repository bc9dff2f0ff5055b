//! The inputs.

use fmi::array;
use fmi::variables::{Array, Field, Variable};

use super::QuadrotorPlant;
use crate::quantities::{FORCE, ROTOR_SPEED, TORQUE};
use crate::tables::{disturbances, ground};

/// A real input within [minimum, maximum], at a field of [`super::Commands`].
macro_rules! real {
    ($name:literal, $quantity:ident, $minimum:literal..=$maximum:literal, $($field:ident).+ $([$index:literal])?, $description:literal) => {
        Variable::<QuadrotorPlant>::input(
            $name,
            $description,
            Field::Real {
                quantity: &$quantity,
                minimum: $minimum,
                maximum: $maximum,
                get: |commands| commands.$($field).+ $([$index])?,
                set: |commands, value| commands.$($field).+ $([$index])? = value,
            },
        )
    };
}

macro_rules! failed {
    ($name:literal, $index:literal, $description:literal) => {
        Variable::<QuadrotorPlant>::input(
            $name,
            $description,
            Field::Boolean {
                get: |commands| commands.failed[$index],
                set: |commands, value| commands.failed[$index] = value,
            },
        )
    };
}

/// What drives it.
#[rustfmt::skip]
pub(super) const COMMANDS: [Variable<QuadrotorPlant>; 12] = [
    real!("rotor.command[1]", ROTOR_SPEED, 0.0..=10000.0, rotor_rad_s[0], "Commanded speed of the front rotor; matters with actuation = rotor_speeds"),
    real!("rotor.command[2]", ROTOR_SPEED, 0.0..=10000.0, rotor_rad_s[1], "Commanded speed of the right rotor; matters with actuation = rotor_speeds"),
    real!("rotor.command[3]", ROTOR_SPEED, 0.0..=10000.0, rotor_rad_s[2], "Commanded speed of the back rotor; matters with actuation = rotor_speeds"),
    real!("rotor.command[4]", ROTOR_SPEED, 0.0..=10000.0, rotor_rad_s[3], "Commanded speed of the left rotor; matters with actuation = rotor_speeds"),
    failed!("rotor.failed[1]", 0, "Whether the motor of the front rotor has no power, so that the rotor comes to rest"),
    failed!("rotor.failed[2]", 1, "Whether the motor of the right rotor has no power, so that the rotor comes to rest"),
    failed!("rotor.failed[3]", 2, "Whether the motor of the back rotor has no power, so that the rotor comes to rest"),
    failed!("rotor.failed[4]", 3, "Whether the motor of the left rotor has no power, so that the rotor comes to rest"),
    real!("command.thrust", FORCE, 0.0..=1e4, wrench.thrust_n, "Thrust F in place of the rotors'; matters with actuation = wrench"),
    real!("command.torque.phi", TORQUE, -1e3..=1e3, wrench.torque_n_m.x, "Torque about the forward axis in place of the rotors'; matters with actuation = wrench"),
    real!("command.torque.theta", TORQUE, -1e3..=1e3, wrench.torque_n_m.y, "Torque about the right axis in place of the rotors'; matters with actuation = wrench"),
    real!("command.torque.psi", TORQUE, -1e3..=1e3, wrench.torque_n_m.z, "Torque about the down axis in place of the rotors'; matters with actuation = wrench"),
];

/// What pushes it.
pub(super) const DISTURBANCE: [Variable<QuadrotorPlant>; 9] = disturbances::disturbance();

/// What it stands on.
pub(super) const GROUND: [Variable<QuadrotorPlant>; 1] = ground::ground(ground::OF_PLANT);

/// What drives it, as vectors.
#[rustfmt::skip]
pub(super) const ARRAYS: &[Array] = &[
    array!("rotor.command", ["[1]", "[2]", "[3]", "[4]"], "Commanded speeds of the front, right, back and left rotor; matter with actuation = rotor_speeds"),
    array!("rotor.failed", ["[1]", "[2]", "[3]", "[4]"], "Whether the motors of the front, right, back and left rotor have no power, so that the rotors come to rest"),
    array!("command.torque", [".phi", ".theta", ".psi"], "Torque about the forward, right and down axes in place of the rotors'; matters with actuation = wrench"),
];
