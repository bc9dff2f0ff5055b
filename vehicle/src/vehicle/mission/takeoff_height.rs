//! How high a mission takes off.

use nalgebra::Vector3;

use super::super::situation::Situation;
use crate::plan::Place;

/// Lower than this above home, m, a height is none.
const LEAST_M: f64 = 0.5;

/// How high it climbs, m, if a mission names no height: ArduPilot's no higher than it takes for a flight.
pub fn height_without_m(situation: &Situation) -> f64 {
    const LIFTED_M: f64 = 1.0;
    if situation.identity.is_ardupilot() { LIFTED_M } else { situation.conduct.takeoff_height_m }
}

/// z to climb to: that of the step's place, or another height above home where it has none.
pub fn takeoff_z_m(place: &Place, home_z_m: f64, takeoff_height_m: f64) -> f64 {
    match place.down_m(home_z_m) {
        Some(z_m) if home_z_m - z_m >= LEAST_M => z_m,
        _ => home_z_m - takeoff_height_m,
    }
}

/// z to climb to on the ground before a step that takes off nowhere: that of the end of its way, and at least that of a takeoff.
pub fn climb_z_m(end_m: Option<Vector3<f64>>, home_z_m: f64, takeoff_height_m: f64) -> f64 {
    let least_z_m = home_z_m - takeoff_height_m;
    end_m.map_or(least_z_m, |end_m| end_m.z.min(least_z_m))
}
