//! What the estimator knows of the vehicle.

use nalgebra::{UnitQuaternion, Vector2};
use quadrotor::RigidBody;

/// The vehicle's motion as estimated, and how much it is worth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Simulation time that it is for, µs.
    pub time_us: u64,
    /// Position and velocity in NED, attitude FRD into NED, body rates.
    pub body: RigidBody,
    /// What of it can be flown by.
    pub validity: Validity,
    /// Standard deviation of the horizontal position, m.
    pub horizontal_accuracy_m: f64,
    /// Of the vertical position, m.
    pub vertical_accuracy_m: f64,
    /// How far the last measurements were from what was expected of them.
    pub test_ratios: TestRatios,
    /// How often position, height or velocity have been set anew because measurements contradicted them for long.
    pub resets: u32,
    /// How far the reported horizontal position has shifted since the start because the receiver's position jumped, m, motion not included.
    pub slid_m: Vector2<f64>,
    /// When it started again last, as the inertial unit contradicted the receiver, µs.
    pub restarted_us: Option<u64>,
}

/// What of an estimate can be flown by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Validity {
    /// Roll and pitch.
    pub tilt: bool,
    /// Heading.
    pub heading: bool,
    /// Velocity north and east.
    pub horizontal_velocity: bool,
    /// Velocity down.
    pub vertical_velocity: bool,
    /// Position north and east, with a receiver that still confirms it.
    pub horizontal_position: bool,
    /// Height.
    pub vertical_position: bool,
}

/// Innovations over their gates, as ESTIMATOR_STATUS has them: what is beyond 1 was rejected.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct TestRatios {
    /// Velocity of the GPS receiver.
    pub velocity: f64,
    /// Its horizontal position.
    pub horizontal_position: f64,
    /// Barometric height.
    pub height: f64,
    /// Magnetic heading.
    pub heading: f64,
}

impl Validity {
    /// All of it.
    pub const ALL: Self = Self {
        tilt: true,
        heading: true,
        horizontal_velocity: true,
        vertical_velocity: true,
        horizontal_position: true,
        vertical_position: true,
    };

    /// Everything that a flight by position needs.
    pub fn all(&self) -> bool {
        *self == Self::ALL
    }
}

impl Estimate {
    /// Nothing known but where the vehicle is told to stand: at rest, level, with a heading, rad.
    pub fn unaligned(position_m: nalgebra::Vector3<f64>, heading_rad: f64) -> Self {
        Self {
            time_us: 0,
            body: RigidBody {
                position_m,
                velocity_m_s: nalgebra::Vector3::zeros(),
                attitude: UnitQuaternion::from_euler_angles(0.0, 0.0, heading_rad).into_inner(),
                body_rate_rad_s: nalgebra::Vector3::zeros(),
            },
            validity: Validity::default(),
            horizontal_accuracy_m: 0.0,
            vertical_accuracy_m: 0.0,
            test_ratios: TestRatios::default(),
            resets: 0,
            slid_m: Vector2::zeros(),
            restarted_us: None,
        }
    }
}
