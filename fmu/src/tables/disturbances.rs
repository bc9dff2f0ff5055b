//! What pushes the vehicle.

use fmi::Model;
use fmi::variables::{Field, Variable};
use quadrotor::{Disturbance, Inputs};

use super::rows::symmetric_input;
use crate::quantities::{FORCE, TORQUE, VELOCITY};

/// Inputs with a disturbance among them.
pub(crate) trait Disturbed {
    /// What pushes.
    fn disturbance(&self) -> &Disturbance;
    /// What pushes, to be changed.
    fn disturbance_mut(&mut self) -> &mut Disturbance;
}

impl Disturbed for Inputs {
    fn disturbance(&self) -> &Disturbance {
        &self.disturbance
    }

    fn disturbance_mut(&mut self) -> &mut Disturbance {
        &mut self.disturbance
    }
}

/// A real input within ±limit, at a field of the disturbance.
macro_rules! real {
    ($($row:tt)+) => { symmetric_input!(disturbance, disturbance_mut, $($row)+) };
}

/// Force, torque and wind.
#[rustfmt::skip]
pub(crate) const fn disturbance<M: Model<Inputs: Disturbed>>() -> [Variable<M>; 9] {
    [
        real!("disturbance.force.x", FORCE, 1e4, force_n.x, "Force on the centre of mass, north"),
        real!("disturbance.force.y", FORCE, 1e4, force_n.y, "Force on the centre of mass, east"),
        real!("disturbance.force.z", FORCE, 1e4, force_n.z, "Force on the centre of mass, down"),
        real!("disturbance.torque.x", TORQUE, 1e3, torque_n_m.x, "Torque about the forward axis"),
        real!("disturbance.torque.y", TORQUE, 1e3, torque_n_m.y, "Torque about the right axis"),
        real!("disturbance.torque.z", TORQUE, 1e3, torque_n_m.z, "Torque about the down axis of the body"),
        real!("wind.velocity.x", VELOCITY, 200.0, wind_m_s.x, "Wind velocity north; acts through airframe.drag, airframe.body_drag and the rotors' coefficients"),
        real!("wind.velocity.y", VELOCITY, 200.0, wind_m_s.y, "Wind velocity east; acts through airframe.drag, airframe.body_drag and the rotors' coefficients"),
        real!("wind.velocity.z", VELOCITY, 200.0, wind_m_s.z, "Wind velocity down; acts through airframe.drag, airframe.body_drag and the rotors' coefficients"),
    ]
}
