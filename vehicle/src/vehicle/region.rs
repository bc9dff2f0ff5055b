//! The region of interest: what the vehicle turns its nose to while it flies a mission, takes off, or holds its place.

use nalgebra::Vector3;
use quadrotor::PositionReference;

use crate::plan::{MissionItem, Site, command};

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
    /// What an item names: DO_SET_ROI and its successors. `here_m` stands in for a place that an item leaves open, `items` are
    /// those of the mission.
    pub fn of(item: &MissionItem, site: &Site, here_m: &Vector3<f64>, items: &[MissionItem]) -> Option<Self> {
        let place = |item: &MissionItem| {
            site.place(item).map(|place| {
                let [x, y] = place.horizontal_m.unwrap_or([here_m.x, here_m.y]);
                Self::Place(Vector3::new(x, y, place.down_m.unwrap_or(0.0)))
            })
        };
        match (item.command, item.parameter_or(1, 0.0) as i64) {
            (command::DO_SET_ROI_LOCATION, _) | (command::DO_SET_ROI, 3) => place(item),
            (command::DO_SET_ROI_WPNEXT_OFFSET, _) => {
                Some(Self::NextWaypoint(item.parameter_or(7, 0.0).to_radians()))
            }
            (command::DO_SET_ROI, 1) => Some(Self::NextWaypoint(0.0)),
            (command::DO_SET_ROI, 2) => items.get(item.parameter(2) as usize).and_then(place),
            // ArduPilot's clients send the place without saying that it is one.
            (command::DO_SET_ROI, 0) if item.position.iter().any(|value| *value != 0.0) => place(item),
            _ => None,
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
