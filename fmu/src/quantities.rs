//! Physical quantities: the declared types of the variables.

use fmi::variables::{Quantity, Unit};
use quadrotor::Unit as Si;

use crate::units::*;

const fn quantity(
    name: &'static str,
    description: &'static str,
    unit: Option<&'static Unit>,
    display_unit: Option<&'static str>,
    nominal: f64,
) -> Quantity {
    Quantity { name, description, unit, display_unit, nominal }
}

pub(crate) const NUMBER: Quantity = quantity("Number", "Dimensionless number", None, None, 1.0);
pub(crate) const TIME: Quantity = quantity("Time", "Time", Some(&SECOND), None, 1.0);
pub(crate) const MASS: Quantity = quantity("Mass", "Mass", Some(&KILOGRAM), None, 1.0);
pub(crate) const POSITION: Quantity = quantity("Position", "Position or length", Some(&METRE), None, 10.0);
pub(crate) const VELOCITY: Quantity = quantity("Velocity", "Velocity", Some(&METRE_PER_SECOND), None, 5.0);
pub(crate) const ACCELERATION: Quantity =
    quantity("Acceleration", "Acceleration", Some(&METRE_PER_SECOND_SQUARED), None, 3.0);
pub(crate) const JERK: Quantity =
    quantity("Jerk", "Rate of change of acceleration", Some(&METRE_PER_SECOND_CUBED), None, 10.0);
pub(crate) const ANGLE: Quantity = quantity("Angle", "Angle", Some(&RADIAN), Some("deg"), 0.3);
pub(crate) const ANGULAR_VELOCITY: Quantity =
    quantity("AngularVelocity", "Angular velocity", Some(&RADIAN_PER_SECOND), Some("deg/s"), 1.0);
pub(crate) const ANGULAR_ACCELERATION: Quantity = quantity(
    "AngularAcceleration",
    "Angular acceleration",
    Some(&RADIAN_PER_SECOND_SQUARED),
    Some("deg/s2"),
    1.0,
);
pub(crate) const ANGULAR_JERK: Quantity = quantity(
    "AngularJerk",
    "Rate of change of angular acceleration",
    Some(&RADIAN_PER_SECOND_CUBED),
    Some("deg/s3"),
    1.0,
);
pub(crate) const ROTOR_SPEED: Quantity =
    quantity("RotorSpeed", "Speed of a rotor", Some(&RADIAN_PER_SECOND), Some("rpm"), 250.0);
pub(crate) const ROTOR_ACCELERATION: Quantity = quantity(
    "RotorAcceleration",
    "Rate of change of a rotor's speed",
    Some(&RADIAN_PER_SECOND_SQUARED),
    None,
    1e3,
);
pub(crate) const RATE: Quantity =
    quantity("Rate", "Rate of change of a dimensionless number", Some(&PER_SECOND), None, 1.0);
pub(crate) const FORCE: Quantity = quantity("Force", "Force", Some(&NEWTON), None, 7.0);
pub(crate) const TORQUE: Quantity = quantity("Torque", "Torque", Some(&NEWTON_METRE), None, 0.3);
pub(crate) const MOMENT_OF_INERTIA: Quantity =
    quantity("MomentOfInertia", "Moment of inertia", Some(&KILOGRAM_SQUARE_METRE), None, 0.1);
pub(crate) const THRUST_COEFFICIENT: Quantity =
    quantity("ThrustCoefficient", "Thrust per squared rotor speed", Some(&NEWTON_SECOND_SQUARED), None, 1e-5);
pub(crate) const TORQUE_COEFFICIENT: Quantity = quantity(
    "TorqueCoefficient",
    "Torque per squared rotor speed",
    Some(&NEWTON_METRE_SECOND_SQUARED),
    None,
    1e-7,
);
pub(crate) const DRAG_COEFFICIENT: Quantity =
    quantity("DragCoefficient", "Drag force per velocity", Some(&NEWTON_SECOND_PER_METRE), None, 0.1);
pub(crate) const ROTOR_AIR_COEFFICIENT: Quantity = quantity(
    "RotorAirCoefficient",
    "Force per rotor speed and velocity",
    Some(&NEWTON_SECOND_SQUARED_PER_METRE),
    None,
    1e-4,
);
pub(crate) const LIFT_COEFFICIENT: Quantity = quantity(
    "LiftCoefficient",
    "Force per squared velocity",
    Some(&NEWTON_SECOND_SQUARED_PER_SQUARE_METRE),
    None,
    1e-3,
);
pub(crate) const VOLTAGE: Quantity = quantity("Voltage", "Voltage", Some(&VOLT), None, 10.0);
pub(crate) const CURRENT: Quantity = quantity("Current", "Current", Some(&AMPERE), None, 10.0);
pub(crate) const RESISTANCE: Quantity = quantity("Resistance", "Resistance", Some(&OHM), None, 0.01);
pub(crate) const CHARGE: Quantity = quantity("Charge", "Charge", Some(&AMPERE_SECOND), Some("A.h"), 1e4);

/// All quantities of the closed loop, in the order of its description.
pub(crate) const ALL: &[&Quantity] = &[
    &NUMBER,
    &TIME,
    &MASS,
    &POSITION,
    &VELOCITY,
    &ACCELERATION,
    &JERK,
    &ANGLE,
    &ANGULAR_VELOCITY,
    &ANGULAR_ACCELERATION,
    &ANGULAR_JERK,
    &ROTOR_SPEED,
    &FORCE,
    &TORQUE,
    &MOMENT_OF_INERTIA,
    &THRUST_COEFFICIENT,
    &TORQUE_COEFFICIENT,
    &DRAG_COEFFICIENT,
    &ROTOR_AIR_COEFFICIENT,
    &LIFT_COEFFICIENT,
    &VOLTAGE,
    &CURRENT,
    &RESISTANCE,
    &CHARGE,
];

/// The quantity of a parameter with this name and unit.
pub(crate) const fn of_parameter(name: &str, unit: Si) -> &'static Quantity {
    match unit {
        Si::One => &NUMBER,
        Si::Kilogram => &MASS,
        Si::Metre => &POSITION,
        Si::Second => &TIME,
        Si::Radian => &ANGLE,
        Si::Newton => &FORCE,
        Si::NewtonMetre => &TORQUE,
        Si::MetrePerSecond => &VELOCITY,
        Si::MetrePerSecondSquared => &ACCELERATION,
        Si::MetrePerSecondCubed => &JERK,
        // The same unit, but people count the turns of a rotor.
        Si::RadianPerSecond if is_of_rotor(name) => &ROTOR_SPEED,
        Si::RadianPerSecond => &ANGULAR_VELOCITY,
        Si::RadianPerSecondSquared => &ANGULAR_ACCELERATION,
        Si::RadianPerSecondCubed => &ANGULAR_JERK,
        Si::KilogramSquareMetre => &MOMENT_OF_INERTIA,
        Si::NewtonSecondSquared => &THRUST_COEFFICIENT,
        Si::NewtonMetreSecondSquared => &TORQUE_COEFFICIENT,
        Si::NewtonSecondPerMetre => &DRAG_COEFFICIENT,
        Si::NewtonSecondSquaredPerMetre => &ROTOR_AIR_COEFFICIENT,
        Si::NewtonSecondSquaredPerSquareMetre => &LIFT_COEFFICIENT,
        Si::Volt => &VOLTAGE,
        Si::Ampere => &CURRENT,
        Si::Ohm => &RESISTANCE,
        Si::AmpereSecond => &CHARGE,
    }
}

/// Whether a parameter belongs to a rotor, by its name.
const fn is_of_rotor(name: &str) -> bool {
    matches!(name.as_bytes().first_chunk(), Some(b"airframe.rotor."))
}
