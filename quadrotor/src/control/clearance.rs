//! Whether the ground may touch the vehicle.

use crate::{Airframe, Configuration};

/// So high above a ground plane, m, feet that reach down do not touch it.
const CLEARANCE_M: f64 = 0.1;

/// Height above the ground plane, m, if there is one.
pub(crate) fn height_m(configuration: &Configuration, ground_z_m: f64, z_m: f64) -> Option<f64> {
    configuration.environment.ground_plane.then_some(ground_z_m - z_m)
}

/// Whether nothing touches the vehicle at this height above a ground plane, m, in any attitude.
pub(crate) fn is_clear(airframe: &Airframe, height_m: Option<f64>) -> bool {
    height_m.is_none_or(|height_m| height_m > airframe.reach_m() + CLEARANCE_M)
}
