//! Altitudes of places.

/// How high a place is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Altitude {
    /// Above home, wherever home is by then, m.
    AboveHome(f64),
    /// Fixed in the local frame: z, positive down, m.
    Down(f64),
    /// The same, given above the ground there: the way there follows the ground.
    AboveGround(f64),
}

impl Altitude {
    /// z in the local frame, m, while home is at `home_z_m`.
    pub fn down_m(self, home_z_m: f64) -> f64 {
        match self {
            Self::AboveHome(height_m) => home_z_m - height_m,
            Self::Down(z_m) | Self::AboveGround(z_m) => z_m,
        }
    }
}
