//! Places of a plan in the local frame.

use super::Altitude;

/// A place. What the plan left open is `None`.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Place {
    /// North and east, m.
    pub horizontal_m: Option<[f64; 2]>,
    /// How high it is.
    pub altitude: Option<Altitude>,
}

impl Place {
    /// z in the local frame, positive down, m, while home is at `home_z_m`.
    pub fn down_m(&self, home_z_m: f64) -> Option<f64> {
        self.altitude.map(|altitude| altitude.down_m(home_z_m))
    }

    /// Whether the way there follows the ground.
    pub fn is_above_ground(&self) -> bool {
        matches!(self.altitude, Some(Altitude::AboveGround(_)))
    }
}
