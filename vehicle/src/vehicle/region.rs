//! The region of interest: what the vehicle turns its nose to while it flies a mission, takes off, or holds its place.

use nalgebra::Vector3;
use quadrotor::PositionReference;

use crate::plan::Look;

/// What is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RegionOfInterest {
    /// A place, NED, m.
    Place(Vector3<f64>),
    /// Where the leg of a mission leads, plus an angle, rad.
    NextWaypoint(f64),
}

/// Nearer than this, m, there is no direction to a place.
const TOO_NEAR_M: f64 = 0.5;

impl RegionOfInterest {
    /// What a vehicle at `here_m`, NED, looks at while home is at `home_z_m`.
    pub fn of(look: &Look, here_m: &Vector3<f64>, home_z_m: f64) -> Self {
        match look {
            Look::At(place) => {
                let [x, y] = place.horizontal_m.unwrap_or([here_m.x, here_m.y]);
                Self::Place(Vector3::new(x, y, place.down_m(home_z_m).unwrap_or(0.0)))
            }
            Look::NextWaypoint { offset_rad } => Self::NextWaypoint(*offset_rad),
        }
    }

    /// Heading to it, rad, and its rate, rad/s, seen from a reference on a leg that leads to `next_m`; `None` where there is
    /// nothing to be looked at.
    pub fn heading(&self, reference: &PositionReference, next_m: Option<Vector3<f64>>) -> Option<(f64, f64)> {
        let (place_m, offset_rad) = match *self {
            Self::Place(place_m) => (place_m, 0.0),
            Self::NextWaypoint(offset_rad) => (next_m?, offset_rad),
        };
        // ψ = atan2(w_y, w_x),  ψ̇ = (w_y v_x − w_x v_y) / (w_x² + w_y²)
        let (way, v) = ((place_m - reference.position_m).xy(), reference.velocity_m_s);
        let rate_rad_s = (way.y * v.x - way.x * v.y) / way.norm_squared();
        (way.norm() > TOO_NEAR_M).then(|| (libm::atan2(way.y, way.x) + offset_rad, rate_rad_s))
    }
}
