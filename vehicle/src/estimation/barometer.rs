//! The barometer, an MS5611-01BA03.

use super::noise::{Channel, Noise};
use super::wander::warming_walk;
use crate::world::{atmospheric_pressure_pa, pressure_altitude_m};

/// Time between readings, µs: a conversion of pressure and one of temperature take 2 × 9.04 ms at the highest
/// resolution.
pub const PERIOD_US: u64 = 20_000;

// Figures of the MS5611-01BA03 (TE Connectivity, data sheet of 2017, sensor performances at 3 V).
/// Resolution at an oversampling ratio of 4096: 0.012 mbar RMS.
pub const NOISE_PA: f64 = 1.2;
/// Accuracy at 25 °C: ±1.5 mbar, taken as three standard deviations.
const OFFSET_PA: f64 = 150.0 / 3.0;
/// Error band from −20 to 85 °C with autozero at one pressure point: ±2.5 mbar, half of the band over half of the range.
const SLOPE_PA_K: f64 = 250.0 / 52.5;
/// How fast the offset walks, Pa/√s.
pub const WALK_PA_RTS: f64 = warming_walk(SLOPE_PA_K);

/// What the barometer says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BarometerReading {
    /// When, µs.
    pub time_us: u64,
    /// Pressure, Pa.
    pub pressure_pa: f64,
}

impl BarometerReading {
    /// The altitude in the standard atmosphere, m.
    pub fn altitude_m(&self) -> f64 {
        pressure_altitude_m(self.pressure_pa)
    }
}

/// The instrument.
#[derive(Clone, Debug)]
pub struct Barometer {
    noise: Noise,
    offset_pa: f64,
}

impl Barometer {
    /// One that has just been switched on.
    pub fn new(seed: u64) -> Self {
        let mut noise = Noise::new(seed, Channel::Barometer);
        let offset_pa = noise.normal(OFFSET_PA);
        Self { noise, offset_pa }
    }

    /// A reading at an altitude above mean sea level, m, if there is one now.
    pub fn sample(&mut self, time_us: u64, altitude_m: f64) -> Option<BarometerReading> {
        if !time_us.is_multiple_of(PERIOD_US) {
            return None;
        }
        self.offset_pa += self.noise.normal(WALK_PA_RTS * libm::sqrt(PERIOD_US as f64 / 1e6));
        let pressure_pa = atmospheric_pressure_pa(altitude_m) + self.offset_pa + self.noise.normal(NOISE_PA);
        Some(BarometerReading { time_us, pressure_pa })
    }
}
