//! The International Standard Atmosphere below 11 km (ISO 2533:1975).

/// p₀, Pa.
const SEA_LEVEL_PA: f64 = 101_325.0;
/// L / T₀, 1/m: 6.5 K/km of 288.15 K.
const LAPSE_PER_M: f64 = 2.255_77e-5;
/// g M / R L.
const EXPONENT: f64 = 5.255_88;

/// Pressure, Pa, at an altitude above mean sea level, m.
pub fn atmospheric_pressure_pa(altitude_m: f64) -> f64 {
    // p = p₀ (1 − L h / T₀)^(g M / R L)
    SEA_LEVEL_PA * libm::pow((1.0 - LAPSE_PER_M * altitude_m).max(0.0), EXPONENT)
}

/// Altitude above mean sea level, m, at a pressure, Pa.
pub fn pressure_altitude_m(pressure_pa: f64) -> f64 {
    (1.0 - libm::pow(pressure_pa.max(0.0) / SEA_LEVEL_PA, 1.0 / EXPONENT)) / LAPSE_PER_M
}

/// Temperature, °C, at an altitude above mean sea level, m: T₀ − L h.
pub fn atmospheric_temperature_degc(altitude_m: f64) -> f64 {
    15.0 - 0.0065 * altitude_m
}
