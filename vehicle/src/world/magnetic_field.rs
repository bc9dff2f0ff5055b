//! The earth's magnetic field.

use nalgebra::Vector3;

use super::Geodetic;

/// B₀, gauss: the mean at the equator, 3.12 · 10⁻⁵ T.
const EQUATOR_GAUSS: f64 = 0.312;

/// The field at a place, NED, gauss: a dipole along the earth's axis, without declination, so that magnetic north is
/// true north.
pub fn earth_field_ned(place: &Geodetic) -> Vector3<f64> {
    let latitude = place.latitude_deg.to_radians();
    // B_north = B₀ cos φ, B_down = 2 B₀ sin φ
    Vector3::new(EQUATOR_GAUSS * libm::cos(latitude), 0.0, 2.0 * EQUATOR_GAUSS * libm::sin(latitude))
}
