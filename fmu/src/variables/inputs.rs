//! The inputs.

use super::{Input, Quantity, Role, Variable};

/// A real input within ±limit, at a field of [`quadrotor::Inputs`].
macro_rules! real {
    ($name:literal, $quantity:ident, $limit:literal, $($field:ident).+, $description:literal) => {
        Variable {
            name: $name,
            description: $description,
            role: Role::Input(Input::Real {
                quantity: Quantity::$quantity,
                minimum: -$limit,
                maximum: $limit,
                get: |inputs| inputs.$($field).+,
                set: |inputs, value| inputs.$($field).+ = value,
            }),
        }
    };
}

#[rustfmt::skip]
pub(super) const INPUTS: [Variable; 21] = [
    real!("reference.position.x", Position, 1e6, reference.position_m.x, "Position reference north"),
    real!("reference.position.y", Position, 1e6, reference.position_m.y, "Position reference east"),
    real!("reference.position.z", Position, 1e6, reference.position_m.z, "Position reference down: minus the height"),
    real!("reference.velocity.x", Velocity, 1e3, reference.velocity_m_s.x, "Velocity reference north"),
    real!("reference.velocity.y", Velocity, 1e3, reference.velocity_m_s.y, "Velocity reference east"),
    real!("reference.velocity.z", Velocity, 1e3, reference.velocity_m_s.z, "Velocity reference down"),
    real!("reference.acceleration.x", Acceleration, 1e3, reference.acceleration_m_s2.x, "Acceleration reference north, fed forward without shaping"),
    real!("reference.acceleration.y", Acceleration, 1e3, reference.acceleration_m_s2.y, "Acceleration reference east, fed forward without shaping"),
    real!("reference.acceleration.z", Acceleration, 1e3, reference.acceleration_m_s2.z, "Acceleration reference down, fed forward without shaping"),
    real!("reference.yaw", Angle, 1e4, reference.yaw_rad, "Heading reference, any number of turns"),
    real!("reference.yaw_rate", AngularVelocity, 100.0, reference.yaw_rate_rad_s, "Rate of the heading reference"),
    real!("disturbance.force.x", Force, 1e4, disturbance.force_n.x, "Force on the centre of mass, north"),
    real!("disturbance.force.y", Force, 1e4, disturbance.force_n.y, "Force on the centre of mass, east"),
    real!("disturbance.force.z", Force, 1e4, disturbance.force_n.z, "Force on the centre of mass, down"),
    real!("disturbance.torque.x", Torque, 1e3, disturbance.torque_n_m.x, "Torque about the forward axis"),
    real!("disturbance.torque.y", Torque, 1e3, disturbance.torque_n_m.y, "Torque about the right axis"),
    real!("disturbance.torque.z", Torque, 1e3, disturbance.torque_n_m.z, "Torque about the down axis of the body"),
    real!("wind.velocity.x", Velocity, 200.0, disturbance.wind_m_s.x, "Velocity of the air north; acts through airframe.drag"),
    real!("wind.velocity.y", Velocity, 200.0, disturbance.wind_m_s.y, "Velocity of the air east; acts through airframe.drag"),
    real!("wind.velocity.z", Velocity, 200.0, disturbance.wind_m_s.z, "Velocity of the air down; acts through airframe.drag"),
    Variable {
        name: "armed",
        description: "Whether the rotors turn",
        role: Role::Input(Input::Boolean {
            get: |inputs| inputs.armed,
            set: |inputs, value| inputs.armed = value,
        }),
    },
];
