//! The magnetometer, an RM3100, calibrated for the vehicle's own field.

use nalgebra::{UnitQuaternion, Vector3};

use super::noise::{Channel, Noise};

/// Time between readings, µs; three axes at 200 cycle counts can be read at 147 Hz.
pub const PERIOD_US: u64 = 20_000;

// Figures of the RM3100 (PNI Sensor, user manual r07, table 3-1), at 200 cycle counts.
/// Noise: 15 nT; gauss.
const NOISE_GAUSS: f64 = 15e-9 * 1e4;
/// Gain: 75 LSB/µT.
pub const COUNTS_PER_GAUSS: f64 = 7500.0;

/// What the magnetometer says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MagnetometerReading {
    /// When, µs.
    pub time_us: u64,
    /// Field, FRD, gauss.
    pub field_gauss: Vector3<f64>,
}

/// The instrument.
#[derive(Clone, Debug)]
pub struct Magnetometer {
    noise: Noise,
}

impl Magnetometer {
    /// One that has just been switched on.
    pub fn new(seed: u64) -> Self {
        Self { noise: Noise::new(seed, Channel::Magnetometer) }
    }

    /// A reading of a field, NED, gauss, if there is one now.
    pub fn sample(
        &mut self,
        time_us: u64,
        attitude: &UnitQuaternion<f64>,
        field_ned: impl FnOnce() -> Vector3<f64>,
    ) -> Option<MagnetometerReading> {
        if !time_us.is_multiple_of(PERIOD_US) {
            return None;
        }
        let field_gauss = attitude.inverse_transform_vector(&field_ned()) + self.noise.vector(NOISE_GAUSS);
        Some(MagnetometerReading { time_us, field_gauss })
    }
}
