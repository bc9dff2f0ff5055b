//! The outputs, and the derivatives of those that are states.

use fmi::array;
use fmi::variables::{Array, Variable};

use super::{Observed, QuadrotorPlant};
use crate::quantities::{ACCELERATION, ANGULAR_ACCELERATION, NUMBER, RATE, ROTOR_ACCELERATION, VELOCITY};
use crate::tables::motion;
use crate::tables::rows::{at_least, output};

/// The motion of the vehicle, its rotors and its battery, as the closed loop shows it.
pub(super) const MOTION: [Variable<QuadrotorPlant>; 34] = motion::motion();

/// A state that the closed loop does not show.
pub(super) const DISCHARGE: [Variable<QuadrotorPlant>; 1] = [at_least(
    output(
        "battery.discharge",
        &NUMBER,
        &["initial.discharge"],
        |observed: &Observed| observed.discharge,
        "Drawn share of the battery's charge: 0 is full, beyond 1 it is empty; constant without airframe.battery.sag",
    ),
    0.0,
)];

// The initial values of derivatives depend on inputs and parameters whose names begin so.
const FORCES: &[&str] = &[
    "actuation",
    "airframe.",
    "command.thrust",
    "disturbance.force.",
    "wind.velocity.",
    "ground.z",
    "environment.",
    "initial.",
];
const TURN: &[&str] = &["initial.attitude.", "initial.body_rate."];
const TORQUES: &[&str] = &[
    "actuation",
    "airframe.",
    "rotor.",
    "command.",
    "disturbance.",
    "wind.velocity.",
    "ground.z",
    "environment.",
    "initial.",
];
const ROTORS: &[&str] = &["actuation", "airframe.", "rotor.", "initial.hovering", "initial.discharge"];
const CHARGE: &[&str] = &["actuation", "airframe.", "initial.hovering", "initial.discharge"];

/// A row of [`DERIVATIVES`].
macro_rules! derivative {
    ($of:literal, $quantity:ident, $depends_on:expr, |$state:ident| $value:expr, $description:literal) => {
        Variable::derivative(
            concat!("der(", $of, ")"),
            $description,
            $of,
            $depends_on,
            &$quantity,
            |observed: &Observed| {
                let $state = &observed.derivative;
                $value
            },
        )
    };
}

/// In the order of the states.
#[rustfmt::skip]
pub(super) const DERIVATIVES: [Variable<QuadrotorPlant>; 18] = [
    derivative!("position.x", VELOCITY, &["initial.velocity.x"], |state| state.body.position_m.x, "Time derivative of position.x"),
    derivative!("position.y", VELOCITY, &["initial.velocity.y"], |state| state.body.position_m.y, "Time derivative of position.y"),
    derivative!("position.z", VELOCITY, &["initial.velocity.z"], |state| state.body.position_m.z, "Time derivative of position.z"),
    derivative!("velocity.x", ACCELERATION, FORCES, |state| state.body.velocity_m_s.x, "Time derivative of velocity.x"),
    derivative!("velocity.y", ACCELERATION, FORCES, |state| state.body.velocity_m_s.y, "Time derivative of velocity.y"),
    derivative!("velocity.z", ACCELERATION, FORCES, |state| state.body.velocity_m_s.z, "Time derivative of velocity.z"),
    derivative!("attitude.q0", RATE, TURN, |state| state.body.attitude.w, "Time derivative of attitude.q0"),
    derivative!("attitude.q1", RATE, TURN, |state| state.body.attitude.i, "Time derivative of attitude.q1"),
    derivative!("attitude.q2", RATE, TURN, |state| state.body.attitude.j, "Time derivative of attitude.q2"),
    derivative!("attitude.q3", RATE, TURN, |state| state.body.attitude.k, "Time derivative of attitude.q3"),
    derivative!("body_rate.p", ANGULAR_ACCELERATION, TORQUES, |state| state.body.body_rate_rad_s.x, "Time derivative of body_rate.p"),
    derivative!("body_rate.q", ANGULAR_ACCELERATION, TORQUES, |state| state.body.body_rate_rad_s.y, "Time derivative of body_rate.q"),
    derivative!("body_rate.r", ANGULAR_ACCELERATION, TORQUES, |state| state.body.body_rate_rad_s.z, "Time derivative of body_rate.r"),
    derivative!("rotor.speed[1]", ROTOR_ACCELERATION, ROTORS, |state| state.rotor_speed_rad_s[0], "Time derivative of rotor.speed[1]"),
    derivative!("rotor.speed[2]", ROTOR_ACCELERATION, ROTORS, |state| state.rotor_speed_rad_s[1], "Time derivative of rotor.speed[2]"),
    derivative!("rotor.speed[3]", ROTOR_ACCELERATION, ROTORS, |state| state.rotor_speed_rad_s[2], "Time derivative of rotor.speed[3]"),
    derivative!("rotor.speed[4]", ROTOR_ACCELERATION, ROTORS, |state| state.rotor_speed_rad_s[3], "Time derivative of rotor.speed[4]"),
    derivative!("battery.discharge", RATE, CHARGE, |state| state.discharge, "Time derivative of battery.discharge"),
];

/// Derivatives as vectors.
#[rustfmt::skip]
pub(super) const ARRAYS: &[Array] = &[
    array!("der(position" as "der(position)", [".x)", ".y)", ".z)"], "Time derivative of the position: north, east, down"),
    array!("der(velocity" as "der(velocity)", [".x)", ".y)", ".z)"], "Time derivative of the velocity: north, east, down"),
    array!("der(attitude.q" as "der(quaternion)", ["0)", "1)", "2)", "3)"], "Time derivative of the attitude quaternion, scalar part first"),
    array!("der(body_rate" as "der(body_rate)", [".p)", ".q)", ".r)"], "Time derivative of the body rates: roll, pitch, yaw"),
    array!("der(rotor.speed" as "der(rotor.speed)", ["[1])", "[2])", "[3])", "[4])"], "Time derivatives of the speeds of the front, right, back and left rotor"),
];
