//! What of the vehicle is measured, and how.

use fmi::variables::{Choice, Field, Variable};
use serde::{Deserialize, Serialize};

use super::{Controller, ControllerParameters};

/// In which variables the attitude is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum AttitudeMeasurement {
    /// As a quaternion.
    Quaternion,
    /// As Euler angles: zeros, with which some importers begin, are an attitude.
    #[default]
    EulerAngles,
}

/// Where rotor speeds come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum RotorSpeedMeasurement {
    /// They are measured.
    Measured,
    /// They follow from the commands and the rotors' lag: what a plant without rotors, or an importer that begins with zeros, needs.
    #[default]
    Predicted,
}

/// What is measured, and how.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Measurements {
    /// The attitude.
    pub attitude: AttitudeMeasurement,
    /// The speeds of the rotors.
    pub rotor_speeds: RotorSpeedMeasurement,
}

const ATTITUDE: Choice = Choice {
    name: "AttitudeMeasurement",
    description: "Variables in which the attitude is measured",
    items: &[
        ("quaternion", "measured.attitude.q0 to q3; the Euler angles are not looked at"),
        ("euler_angles", "measured.attitude.phi, theta and psi; the quaternion is not looked at"),
    ],
};

const ROTOR_SPEEDS: Choice = Choice {
    name: "RotorSpeedMeasurement",
    description: "Where the speeds of the rotors come from",
    items: &[
        ("measured", "measured.rotor.speed[1] to [4]"),
        (
            "predicted",
            "From the commands and airframe.rotor.time_constant; armed at the start, the rotors carry the weight",
        ),
    ],
};

/// What is measured, and how.
pub(super) const TABLE: [Variable<Controller>; 2] = [
    Variable::fixed(
        "measurement.attitude",
        "Variables in which the attitude is measured: 1 = quaternion, 2 = euler_angles",
        Field::Enumeration {
            choice: ATTITUDE,
            get: |parameters: &ControllerParameters| match parameters.measurements.attitude {
                AttitudeMeasurement::Quaternion => 1,
                AttitudeMeasurement::EulerAngles => 2,
            },
            set: |parameters: &mut ControllerParameters, item| {
                parameters.measurements.attitude = if item == 2 {
                    AttitudeMeasurement::EulerAngles
                } else {
                    AttitudeMeasurement::Quaternion
                };
            },
        },
    ),
    Variable::fixed(
        "measurement.rotor_speeds",
        "Where the speeds of the rotors come from when the vehicle is taken over, at the start and when it is armed: 1 = measured, 2 = predicted",
        Field::Enumeration {
            choice: ROTOR_SPEEDS,
            get: |parameters: &ControllerParameters| match parameters.measurements.rotor_speeds {
                RotorSpeedMeasurement::Measured => 1,
                RotorSpeedMeasurement::Predicted => 2,
            },
            set: |parameters: &mut ControllerParameters, item| {
                parameters.measurements.rotor_speeds = if item == 2 {
                    RotorSpeedMeasurement::Predicted
                } else {
                    RotorSpeedMeasurement::Measured
                };
            },
        },
    ),
];

/// The same as integers.
pub(super) const NUMBERS: [Variable<Controller>; 2] = [
    Variable::number(
        "measurement.attitude_number",
        "measurement.attitude by its number, which wins over the name; 0: as measurement.attitude says",
        "measurement.attitude",
    ),
    Variable::number(
        "measurement.rotor_speeds_number",
        "measurement.rotor_speeds by its number, which wins over the name; 0: as measurement.rotor_speeds says",
        "measurement.rotor_speeds",
    ),
];
