//! Physical quantities: the types of the variables, with their units.

use quadrotor::Unit;

/// Physical quantity of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Dimensionless.
    Number,
    /// Time.
    Time,
    /// Mass.
    Mass,
    /// Position or length.
    Position,
    /// Velocity.
    Velocity,
    /// Acceleration.
    Acceleration,
    /// Jerk.
    Jerk,
    /// Angle.
    Angle,
    /// Angular velocity.
    AngularVelocity,
    /// Angular acceleration.
    AngularAcceleration,
    /// Angular jerk.
    AngularJerk,
    /// Speed of a rotor.
    RotorSpeed,
    /// Force.
    Force,
    /// Torque.
    Torque,
    /// Moment of inertia.
    MomentOfInertia,
    /// Thrust per squared rotor speed.
    ThrustCoefficient,
    /// Torque per squared rotor speed.
    TorqueCoefficient,
    /// Drag force per velocity.
    DragCoefficient,
}

/// How a quantity appears in the description.
#[derive(Clone, Copy, Debug)]
pub struct QuantityType {
    /// Name of its simple type.
    pub name: &'static str,
    /// What it is.
    pub description: &'static str,
    /// Name of its unit; `None` if it has none.
    pub unit: Option<&'static str>,
    /// Unit that a person prefers to read.
    pub display_unit: Option<&'static str>,
    /// Typical magnitude.
    pub nominal: f64,
}

impl Quantity {
    /// All quantities.
    pub const ALL: [Self; 18] = [
        Self::Number,
        Self::Time,
        Self::Mass,
        Self::Position,
        Self::Velocity,
        Self::Acceleration,
        Self::Jerk,
        Self::Angle,
        Self::AngularVelocity,
        Self::AngularAcceleration,
        Self::AngularJerk,
        Self::RotorSpeed,
        Self::Force,
        Self::Torque,
        Self::MomentOfInertia,
        Self::ThrustCoefficient,
        Self::TorqueCoefficient,
        Self::DragCoefficient,
    ];

    /// How it appears in the description.
    #[rustfmt::skip]
    pub const fn quantity_type(self) -> QuantityType {
        let (name, description, unit, display_unit, nominal) = match self {
            Self::Number => ("Number", "Dimensionless number", None, None, 1.0),
            Self::Time => ("Time", "Time", Some("s"), None, 1.0),
            Self::Mass => ("Mass", "Mass", Some("kg"), None, 1.0),
            Self::Position => ("Position", "Position or length", Some("m"), None, 10.0),
            Self::Velocity => ("Velocity", "Velocity", Some("m/s"), None, 5.0),
            Self::Acceleration => ("Acceleration", "Acceleration", Some("m/s2"), None, 3.0),
            Self::Jerk => ("Jerk", "Rate of an acceleration", Some("m/s3"), None, 10.0),
            Self::Angle => ("Angle", "Angle", Some("rad"), Some("deg"), 0.3),
            Self::AngularVelocity => ("AngularVelocity", "Angular velocity", Some("rad/s"), Some("deg/s"), 1.0),
            Self::AngularAcceleration => ("AngularAcceleration", "Angular acceleration", Some("rad/s2"), Some("deg/s2"), 1.0),
            Self::AngularJerk => ("AngularJerk", "Rate of an angular acceleration", Some("rad/s3"), Some("deg/s3"), 1.0),
            Self::RotorSpeed => ("RotorSpeed", "Speed of a rotor", Some("rad/s"), Some("rpm"), 250.0),
            Self::Force => ("Force", "Force", Some("N"), None, 7.0),
            Self::Torque => ("Torque", "Torque", Some("N.m"), None, 0.3),
            Self::MomentOfInertia => ("MomentOfInertia", "Moment of inertia", Some("kg.m2"), None, 0.1),
            Self::ThrustCoefficient => ("ThrustCoefficient", "Thrust per squared rotor speed", Some("N.s2"), None, 1e-5),
            Self::TorqueCoefficient => ("TorqueCoefficient", "Torque per squared rotor speed", Some("N.m.s2"), None, 1e-7),
            Self::DragCoefficient => ("DragCoefficient", "Drag force per velocity", Some("N.s/m"), None, 0.1),
        };
        QuantityType { name, description, unit, display_unit, nominal }
    }

    /// The quantity of a parameter with this name and unit.
    pub fn of_parameter(name: &str, unit: Unit) -> Self {
        match unit {
            Unit::One => Self::Number,
            Unit::Kilogram => Self::Mass,
            Unit::Metre => Self::Position,
            Unit::Second => Self::Time,
            Unit::Radian => Self::Angle,
            Unit::Newton => Self::Force,
            Unit::NewtonMetre => Self::Torque,
            Unit::MetrePerSecond => Self::Velocity,
            Unit::MetrePerSecondSquared => Self::Acceleration,
            Unit::MetrePerSecondCubed => Self::Jerk,
            // The same unit, but people count the turns of a rotor.
            Unit::RadianPerSecond if name.starts_with("airframe.rotor.") => Self::RotorSpeed,
            Unit::RadianPerSecond => Self::AngularVelocity,
            Unit::RadianPerSecondSquared => Self::AngularAcceleration,
            Unit::RadianPerSecondCubed => Self::AngularJerk,
            Unit::KilogramSquareMetre => Self::MomentOfInertia,
            Unit::NewtonSecondSquared => Self::ThrustCoefficient,
            Unit::NewtonMetreSecondSquared => Self::TorqueCoefficient,
            Unit::NewtonSecondPerMetre => Self::DragCoefficient,
        }
    }
}
