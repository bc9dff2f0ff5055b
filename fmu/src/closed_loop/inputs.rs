//! The inputs.

use fmi::variables::{Field, Variable};

use super::ClosedLoop;
use crate::quantities::{ACCELERATION, ANGLE, ANGULAR_VELOCITY, FORCE, POSITION, TORQUE, VELOCITY};

/// A real input within ±limit, at a field of [`quadrotor::Inputs`].
macro_rules! real {
    ($name:literal, $quantity:ident, $limit:literal, $($field:ident).+, $description:literal) => {
        Variable::<ClosedLoop>::input(
            $name,
            $description,
            Field::Real {
                quantity: &$quantity,
                minimum: -$limit,
                maximum: $limit,
                get: |inputs| inputs.$($field).+,
                set: |inputs, value| inputs.$($field).+ = value,
            },
        )
    };
}

#[rustfmt::skip]
pub(super) const INPUTS: [Variable<ClosedLoop>; 21] = [
    real!("reference.position.x", POSITION, 1e6, reference.position_m.x, "Position reference north"),
    real!("reference.position.y", POSITION, 1e6, reference.position_m.y, "Position reference east"),
    real!("reference.position.z", POSITION, 1e6, reference.position_m.z, "Position reference down: minus the altitude"),
    real!("reference.velocity.x", VELOCITY, 1e3, reference.velocity_m_s.x, "Velocity reference north"),
    real!("reference.velocity.y", VELOCITY, 1e3, reference.velocity_m_s.y, "Velocity reference east"),
    real!("reference.velocity.z", VELOCITY, 1e3, reference.velocity_m_s.z, "Velocity reference down"),
    real!("reference.acceleration.x", ACCELERATION, 1e3, reference.acceleration_m_s2.x, "Acceleration reference north, fed forward without shaping"),
    real!("reference.acceleration.y", ACCELERATION, 1e3, reference.acceleration_m_s2.y, "Acceleration reference east, fed forward without shaping"),
    real!("reference.acceleration.z", ACCELERATION, 1e3, reference.acceleration_m_s2.z, "Acceleration reference down, fed forward without shaping"),
    real!("reference.yaw", ANGLE, 1e4, reference.yaw_rad, "Heading reference; may exceed one turn"),
    real!("reference.yaw_rate", ANGULAR_VELOCITY, 100.0, reference.yaw_rate_rad_s, "Rate of the heading reference"),
    real!("disturbance.force.x", FORCE, 1e4, disturbance.force_n.x, "Force on the centre of mass, north"),
    real!("disturbance.force.y", FORCE, 1e4, disturbance.force_n.y, "Force on the centre of mass, east"),
    real!("disturbance.force.z", FORCE, 1e4, disturbance.force_n.z, "Force on the centre of mass, down"),
    real!("disturbance.torque.x", TORQUE, 1e3, disturbance.torque_n_m.x, "Torque about the forward axis"),
    real!("disturbance.torque.y", TORQUE, 1e3, disturbance.torque_n_m.y, "Torque about the right axis"),
    real!("disturbance.torque.z", TORQUE, 1e3, disturbance.torque_n_m.z, "Torque about the down axis of the body"),
    real!("wind.velocity.x", VELOCITY, 200.0, disturbance.wind_m_s.x, "Wind velocity north; acts through airframe.drag, airframe.body_drag and the rotors' coefficients"),
    real!("wind.velocity.y", VELOCITY, 200.0, disturbance.wind_m_s.y, "Wind velocity east; acts through airframe.drag, airframe.body_drag and the rotors' coefficients"),
    real!("wind.velocity.z", VELOCITY, 200.0, disturbance.wind_m_s.z, "Wind velocity down; acts through airframe.drag, airframe.body_drag and the rotors' coefficients"),
    Variable::<ClosedLoop>::input("armed", "Whether the vehicle is armed, so that its rotors turn", Field::Boolean {
        get: |inputs| inputs.armed,
        set: |inputs, value| inputs.armed = value,
    }),
];
