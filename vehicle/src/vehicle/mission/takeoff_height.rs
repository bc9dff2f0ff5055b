//! How high a mission takes off.

use nalgebra::Vector3;

use crate::plan::Place;

/// Lower than this above home, m, a height is none.
const LEAST_M: f64 = 0.5;

/// z to climb to: that of the step's place, or that of the parameter where it has none above home.
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
