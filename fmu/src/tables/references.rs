//! What the vehicle is asked for.

use fmi::Model;
use fmi::variables::{Field, Variable};
use quadrotor::{Inputs, PositionReference};

use super::rows::symmetric_input;
use crate::quantities::{ACCELERATION, ANGLE, ANGULAR_VELOCITY, POSITION, VELOCITY};

/// Inputs that say where a vehicle has to be, and whether its rotors turn.
pub(crate) trait Commanded {
    /// Where to be.
    fn reference(&self) -> &PositionReference;
    /// Where to be, to be changed.
    fn reference_mut(&mut self) -> &mut PositionReference;
    /// Whether the rotors turn.
    fn armed(&self) -> bool;
    /// Sets whether the rotors turn.
    fn set_armed(&mut self, armed: bool);
}

impl Commanded for Inputs {
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

/// A real input within ±limit, at a field of the reference.
macro_rules! real {
    ($($row:tt)+) => { symmetric_input!(reference, reference_mut, $($row)+) };
}

/// The reference.
#[rustfmt::skip]
pub(crate) const fn reference<M: Model<Inputs: Commanded>>() -> [Variable<M>; 11] {
    [
        real!("reference.position.x", POSITION, 1e6, position_m.x, "Position reference north"),
        real!("reference.position.y", POSITION, 1e6, position_m.y, "Position reference east"),
        real!("reference.position.z", POSITION, 1e6, position_m.z, "Position reference down: minus the altitude"),
        real!("reference.velocity.x", VELOCITY, 1e3, velocity_m_s.x, "Velocity reference north"),
        real!("reference.velocity.y", VELOCITY, 1e3, velocity_m_s.y, "Velocity reference east"),
        real!("reference.velocity.z", VELOCITY, 1e3, velocity_m_s.z, "Velocity reference down"),
        real!("reference.acceleration.x", ACCELERATION, 1e3, acceleration_m_s2.x, "Acceleration reference north, fed forward without shaping"),
        real!("reference.acceleration.y", ACCELERATION, 1e3, acceleration_m_s2.y, "Acceleration reference east, fed forward without shaping"),
        real!("reference.acceleration.z", ACCELERATION, 1e3, acceleration_m_s2.z, "Acceleration reference down, fed forward without shaping"),
        real!("reference.yaw", ANGLE, 1e4, yaw_rad, "Heading reference; may exceed one turn"),
        real!("reference.yaw_rate", ANGULAR_VELOCITY, 100.0, yaw_rate_rad_s, "Rate of the heading reference"),
    ]
}

/// Whether the rotors turn.
pub(crate) const fn armed<M: Model<Inputs: Commanded>>() -> [Variable<M>; 1] {
    [Variable::input(
        "armed",
        "Whether the vehicle is armed, so that its rotors turn",
        Field::Boolean {
            get: |inputs: &M::Inputs| inputs.armed(),
            set: |inputs: &mut M::Inputs, value| inputs.set_armed(value),
        },
    )]
}
