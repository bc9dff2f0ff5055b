//! The inputs: what is asked for, and what is measured.

use fmi::array;
use fmi::variables::{Array, Field, Variable};
use quadrotor::{ControlInputs, Inputs, PositionReference, Target};
use serde::{Deserialize, Serialize};

use super::{Controller, MeasuredMotion};
use crate::quantities::{ANGLE, ANGULAR_VELOCITY, NUMBER, POSITION, ROTOR_SPEED, VELOCITY};
use crate::tables::ground::{self, Grounded};
use crate::tables::references::{self, Commanded};

/// What is asked for, and what is measured.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ControllerInputs {
    /// Where to be.
    pub reference: PositionReference,
    /// Whether the rotors turn.
    pub armed: bool,
    /// The motion of the vehicle.
    pub measured: MeasuredMotion,
    /// z of the ground below the vehicle, NED, m.
    pub ground_z_m: f64,
}

/// The reference of the closed loop's default flight, and a vehicle in hover at the origin.
impl Default for ControllerInputs {
    fn default() -> Self {
        let Inputs { reference, armed, ground_z_m, .. } = Inputs::default();
        Self { reference, armed, measured: MeasuredMotion::default(), ground_z_m }
    }
}

impl ControllerInputs {
    /// What the control loop is asked for.
    pub(super) fn control(&self) -> ControlInputs {
        ControlInputs {
            armed: self.armed,
            ground_z_m: self.ground_z_m,
            ..ControlInputs::armed(Target::Reference(self.reference))
        }
    }
}

impl Commanded for ControllerInputs {
    fn reference(&self) -> &PositionReference {
        &self.reference
    }

    fn reference_mut(&mut self) -> &mut PositionReference {
        &mut self.reference
    }

    fn armed(&self) -> bool {
        self.armed
    }

    fn set_armed(&mut self, armed: bool) {
        self.armed = armed;
    }
}

impl Grounded for ControllerInputs {
    fn ground_z_m(&self) -> f64 {
        self.ground_z_m
    }

    fn set_ground_z_m(&mut self, ground_z_m: f64) {
        self.ground_z_m = ground_z_m;
    }
}

/// A measured number within a range.
macro_rules! measured {
    ($name:literal, $quantity:ident, $minimum:literal..=$maximum:literal, $field:ident[$index:literal], $description:literal) => {
        Variable::<Controller>::input(
            $name,
            $description,
            Field::Real {
                quantity: &$quantity,
                minimum: $minimum,
                maximum: $maximum,
                get: |inputs: &ControllerInputs| inputs.measured.$field[$index],
                set: |inputs: &mut ControllerInputs, value| inputs.measured.$field[$index] = value,
            },
        )
    };
}

/// What is asked for.
pub(super) const REFERENCE: [Variable<Controller>; 11] = references::reference();

/// What is measured. Ranges are wider than what a plant can do.
#[rustfmt::skip]
pub(super) const MEASURED: [Variable<Controller>; 20] = [
    measured!("measured.position.x", POSITION, -1e7..=1e7, position_m[0], "Measured position north"),
    measured!("measured.position.y", POSITION, -1e7..=1e7, position_m[1], "Measured position east"),
    measured!("measured.position.z", POSITION, -1e7..=1e7, position_m[2], "Measured position down: minus the altitude"),
    measured!("measured.velocity.x", VELOCITY, -1e4..=1e4, velocity_m_s[0], "Measured velocity north; not looked at with sensor.output_feedback"),
    measured!("measured.velocity.y", VELOCITY, -1e4..=1e4, velocity_m_s[1], "Measured velocity east; not looked at with sensor.output_feedback"),
    measured!("measured.velocity.z", VELOCITY, -1e4..=1e4, velocity_m_s[2], "Measured velocity down; not looked at with sensor.output_feedback"),
    measured!("measured.attitude.q0", NUMBER, -10.0..=10.0, quaternion[0], "Measured attitude quaternion, scalar part: body into north-east-down; looked at if measurement.attitude is quaternion"),
    measured!("measured.attitude.q1", NUMBER, -10.0..=10.0, quaternion[1], "Measured attitude quaternion, first vector part"),
    measured!("measured.attitude.q2", NUMBER, -10.0..=10.0, quaternion[2], "Measured attitude quaternion, second vector part"),
    measured!("measured.attitude.q3", NUMBER, -10.0..=10.0, quaternion[3], "Measured attitude quaternion, third vector part"),
    measured!("measured.attitude.phi", ANGLE, -1e4..=1e4, attitude_rad[0], "Measured roll angle (ZYX Euler angles); looked at if measurement.attitude is euler_angles"),
    measured!("measured.attitude.theta", ANGLE, -1e4..=1e4, attitude_rad[1], "Measured pitch angle (ZYX Euler angles)"),
    measured!("measured.attitude.psi", ANGLE, -1e4..=1e4, attitude_rad[2], "Measured heading (ZYX Euler angles)"),
    measured!("measured.body_rate.p", ANGULAR_VELOCITY, -1e4..=1e4, body_rate_rad_s[0], "Measured roll rate; not looked at with sensor.output_feedback"),
    measured!("measured.body_rate.q", ANGULAR_VELOCITY, -1e4..=1e4, body_rate_rad_s[1], "Measured pitch rate; not looked at with sensor.output_feedback"),
    measured!("measured.body_rate.r", ANGULAR_VELOCITY, -1e4..=1e4, body_rate_rad_s[2], "Measured yaw rate; not looked at with sensor.output_feedback"),
    measured!("measured.rotor.speed[1]", ROTOR_SPEED, 0.0..=2e4, rotor_speed_rad_s[0], "Measured speed of the front rotor; looked at when the vehicle is taken over, at the start and when it is armed, if measurement.rotor_speeds is measured"),
    measured!("measured.rotor.speed[2]", ROTOR_SPEED, 0.0..=2e4, rotor_speed_rad_s[1], "Measured speed of the right rotor"),
    measured!("measured.rotor.speed[3]", ROTOR_SPEED, 0.0..=2e4, rotor_speed_rad_s[2], "Measured speed of the back rotor"),
    measured!("measured.rotor.speed[4]", ROTOR_SPEED, 0.0..=2e4, rotor_speed_rad_s[3], "Measured speed of the left rotor"),
];

/// Whether the rotors turn.
pub(super) const ARMED: [Variable<Controller>; 1] = references::armed();

/// What the vehicle flies above.
pub(super) const GROUND: [Variable<Controller>; 1] = ground::ground(
    "z of the ground below the vehicle (positive down): -5 is a plateau 5 m above the origin; nothing is learned close to the ground",
);

/// What is measured, as vectors.
#[rustfmt::skip]
pub(super) const ARRAYS: &[Array] = &[
    array!("measured.position", [".x", ".y", ".z"], "Measured position: north, east, down"),
    array!("measured.velocity", [".x", ".y", ".z"], "Measured velocity: north, east, down"),
    array!("measured.attitude.q" as "measured.quaternion", ["0", "1", "2", "3"], "Measured attitude quaternion, scalar part first: body into north-east-down"),
    array!("measured.attitude", [".phi", ".theta", ".psi"], "Measured ZYX Euler angles: roll, pitch, heading"),
    array!("measured.body_rate", [".p", ".q", ".r"], "Measured body rates: roll, pitch, yaw"),
    array!("measured.rotor.speed", ["[1]", "[2]", "[3]", "[4]"], "Measured speeds of the front, right, back and left rotor"),
];
