//! The inputs.

use fmi::variables::{Field, Variable};

use super::ClosedLoop;
use crate::quantities::{FORCE, TORQUE, VELOCITY};
use crate::tables::references;

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

/// What the vehicle is asked for.
pub(super) const REFERENCE: [Variable<ClosedLoop>; 11] = references::reference();

/// What pushes it.
#[rustfmt::skip]
pub(super) const DISTURBANCE: [Variable<ClosedLoop>; 9] = [
    real!("disturbance.force.x", FORCE, 1e4, disturbance.force_n.x, "Force on the centre of mass, north"),
    real!("disturbance.force.y", FORCE, 1e4, disturbance.force_n.y, "Force on the centre of mass, east"),
    real!("disturbance.force.z", FORCE, 1e4, disturbance.force_n.z, "Force on the centre of mass, down"),
    real!("disturbance.torque.x", TORQUE, 1e3, disturbance.torque_n_m.x, "Torque about the forward axis"),
    real!("disturbance.torque.y", TORQUE, 1e3, disturbance.torque_n_m.y, "Torque about the right axis"),
    real!("disturbance.torque.z", TORQUE, 1e3, disturbance.torque_n_m.z, "Torque about the down axis of the body"),
    real!("wind.velocity.x", VELOCITY, 200.0, disturbance.wind_m_s.x, "Wind velocity north; acts through airframe.drag, airframe.body_drag and the rotors' coefficients"),
    real!("wind.velocity.y", VELOCITY, 200.0, disturbance.wind_m_s.y, "Wind velocity east; acts through airframe.drag, airframe.body_drag and the rotors' coefficients"),
    real!("wind.velocity.z", VELOCITY, 200.0, disturbance.wind_m_s.z, "Wind velocity down; acts through airframe.drag, airframe.body_drag and the rotors' coefficients"),
];

/// Whether its rotors turn.
pub(super) const ARMED: [Variable<ClosedLoop>; 1] = references::armed();
