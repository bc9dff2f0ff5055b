//! Headings for people and clients: the vehicle itself works in radians.

/// A heading as people tell it, degrees within [0, 360).
pub fn heading_deg(yaw_rad: f64) -> f64 {
    let degrees = yaw_rad.to_degrees();
    let within = degrees - 360.0 * (degrees / 360.0).floor();
    if within >= 360.0 { 0.0 } else { within }
}
