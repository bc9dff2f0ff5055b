//! Air pressure and the earth's magnetic field, as instruments on board would meet them.

use nalgebra::Vector3;

use super::Geodetic;

/// Pressure of the International Standard Atmosphere below 11 km, Pa, from the altitude above mean sea level, m.
pub fn atmospheric_pressure_pa(altitude_m: f64) -> f64 {
    // p = p₀ (1 − L h / T₀)^(g M / R L)
    101_325.0 * libm::pow((1.0 - 2.255_77e-5 * altitude_m).max(0.0), 5.255_88)
}

/// The magnetic field, NED, gauss: a dipole along the earth's axis, without declination, so that magnetic
/// north is true north.
pub fn earth_field_ned(place: &Geodetic) -> Vector3<f64> {
    const EQUATOR_GAUSS: f64 = 0.312;
    let latitude = place.latitude_deg.to_radians();
    // B_north = B₀ cos φ, B_down = 2 B₀ sin φ
    Vector3::new(EQUATOR_GAUSS * libm::cos(latitude), 0.0, 2.0 * EQUATOR_GAUSS * libm::sin(latitude))
}

/// The altitude in that atmosphere, m, from the pressure, Pa.
pub fn pressure_altitude_m(pressure_pa: f64) -> f64 {
    (1.0 - libm::pow(pressure_pa.max(0.0) / 101_325.0, 1.0 / 5.255_88)) / 2.255_77e-5
}
