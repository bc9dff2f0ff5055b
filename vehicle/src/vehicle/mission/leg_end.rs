//! Where the leg of a step ends.

use nalgebra::Vector3;

use super::circle_turns::CircleTurns;
use crate::plan::Place;
use crate::plan::step::{Navigate, Turns, Waypoint};

/// Where the leg of a step ends that begins at `from_m`, NED, m; `None` if it has none. `home_z_m` is z of home.
pub fn leg_end_m(step: &Navigate, from_m: &Vector3<f64>, home_z_m: f64) -> Option<Vector3<f64>> {
    let end_m = |place: &Place| place_m(place, from_m, home_z_m);
    match step {
        Navigate::Waypoint(Waypoint { place, .. })
        | Navigate::Loiter { place, .. }
        | Navigate::LoiterTime { place, .. }
        | Navigate::Spline { place, .. }
        | Navigate::PlacePayload { place, .. } => Some(end_m(place)),
        Navigate::LoiterTurns(turns) => Some(circle(turns, from_m, home_z_m).position_m()),
        // At the present height; the other one comes then.
        Navigate::LoiterToAltitude { place } => {
            let end_m = end_m(place);
            Some(Vector3::new(end_m.x, end_m.y, from_m.z))
        }
        // Down it goes only there.
        Navigate::Land { place, .. } => place.horizontal_m.map(|[x, y]| Vector3::new(x, y, from_m.z)),
        Navigate::Takeoff { .. } | Navigate::ReturnToLaunch | Navigate::Delay(_) => None,
    }
}

/// The turns of a vehicle that comes from a place, NED, m.
pub fn circle(turns: &Turns, from_m: &Vector3<f64>, home_z_m: f64) -> CircleTurns {
    CircleTurns::new(place_m(&turns.place, from_m, home_z_m), from_m, turns)
}

/// A place, NED, m; what it leaves open is that of another one.
pub fn place_m(place: &Place, open_m: &Vector3<f64>, home_z_m: f64) -> Vector3<f64> {
    let [x, y] = place.horizontal_m.unwrap_or([open_m.x, open_m.y]);
    Vector3::new(x, y, place.down_m(home_z_m).unwrap_or(open_m.z))
}
