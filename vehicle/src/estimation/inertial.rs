//! The inertial unit: three gyroscopes and three accelerometers, an ICM-42688-P.

use nalgebra::Vector3;
use quadrotor::GRAVITY_M_S2;

use super::noise::{Channel, Noise};
use super::true_motion::TrueMotion;
use super::wander::warming_walk;

/// Time between readings, µs: an output data rate of 1 kHz.
pub const PERIOD_US: u64 = 1_000;

const PERIOD_S: f64 = PERIOD_US as f64 / 1e6;
const RAD_S: f64 = core::f64::consts::PI / 180.0;

// Figures of the ICM-42688-P (TDK InvenSense DS-000347, tables 1 and 2).
/// Rate noise spectral density: 2.8 mdps/√Hz.
pub const GYROSCOPE_NOISE_RAD_S_RTHZ: f64 = 2.8e-3 * RAD_S;
/// Acceleration noise spectral density: 70 µg/√Hz, that of the noisiest axis.
pub const ACCELEROMETER_NOISE_M_S2_RTHZ: f64 = 70e-6 * GRAVITY_M_S2;
/// Zero-rate offset ±0.5 dps: taken as three standard deviations.
const GYROSCOPE_OFFSET_RAD_S: f64 = 0.5 * RAD_S / 3.0;
/// Zero-g offset ±20 mg: taken as three standard deviations.
pub const ACCELEROMETER_OFFSET_M_S2: f64 = 20e-3 * GRAVITY_M_S2 / 3.0;
/// Zero-rate offset over temperature: ±0.005 dps/K.
pub const GYROSCOPE_WALK_RAD_S_RTS: f64 = warming_walk(0.005 * RAD_S);
/// Zero-g offset over temperature: ±0.15 mg/K.
pub const ACCELEROMETER_WALK_M_S2_RTS: f64 = warming_walk(0.15e-3 * GRAVITY_M_S2);
/// Full scale: ±2000 dps and ±16 g.
const GYROSCOPE_RANGE_RAD_S: f64 = 2000.0 * RAD_S;
const ACCELEROMETER_RANGE_M_S2: f64 = 16.0 * GRAVITY_M_S2;
/// Sensitivity: 16.4 LSB/dps.
pub const GYROSCOPE_COUNTS_PER_RAD_S: f64 = 16.4 / RAD_S;
/// Sensitivity: 2048 LSB/g.
pub const ACCELEROMETER_COUNTS_PER_M_S2: f64 = 2048.0 / GRAVITY_M_S2;

/// What the inertial unit says: means over the time since the reading before.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct InertialReading {
    /// End of that time, µs.
    pub time_us: u64,
    /// p, q, r, rad/s.
    pub body_rate_rad_s: Vector3<f64>,
    /// Specific force, FRD, m/s².
    pub specific_force_m_s2: Vector3<f64>,
}

/// The instrument.
#[derive(Clone, Debug)]
pub struct InertialUnit {
    noise: Noise,
    gyroscope_offset: Vector3<f64>,
    accelerometer_offset: Vector3<f64>,
    before: Option<TrueMotion>,
    clipped: [u32; 3],
}

impl InertialUnit {
    /// One that has just been switched on.
    pub fn new(seed: u64) -> Self {
        let mut noise = Noise::new(seed, Channel::Inertial);
        let gyroscope_offset = noise.vector(GYROSCOPE_OFFSET_RAD_S);
        let accelerometer_offset = noise.vector(ACCELEROMETER_OFFSET_M_S2);
        Self { noise, gyroscope_offset, accelerometer_offset, before: None, clipped: [0; 3] }
    }

    /// Takes a reading, once every period.
    pub fn sample(&mut self, motion: &TrueMotion) -> InertialReading {
        let before = self.before.replace(*motion).unwrap_or(*motion);
        let rate = (before.body_rate_rad_s + motion.body_rate_rad_s) / 2.0;
        let force = (before.specific_force_m_s2 + motion.specific_force_m_s2) / 2.0;
        // A one-sided density n over the bandwidth of half the data rate: σ = n √(f/2).
        let root_bandwidth = libm::sqrt(0.5 / PERIOD_S);
        let root_period = libm::sqrt(PERIOD_S);
        self.gyroscope_offset += self.noise.vector(GYROSCOPE_WALK_RAD_S_RTS * root_period);
        self.accelerometer_offset += self.noise.vector(ACCELEROMETER_WALK_M_S2_RTS * root_period);
        let rate =
            rate + self.gyroscope_offset + self.noise.vector(GYROSCOPE_NOISE_RAD_S_RTHZ * root_bandwidth);
        let force = force
            + self.accelerometer_offset
            + self.noise.vector(ACCELEROMETER_NOISE_M_S2_RTHZ * root_bandwidth);
        for (axis, count) in self.clipped.iter_mut().enumerate() {
            *count = count.wrapping_add(u32::from(force[axis].abs() >= ACCELEROMETER_RANGE_M_S2));
        }
        InertialReading {
            time_us: motion.time_us,
            body_rate_rad_s: within(&rate, GYROSCOPE_RANGE_RAD_S),
            specific_force_m_s2: within(&force, ACCELEROMETER_RANGE_M_S2),
        }
    }

    /// How often each accelerometer was beyond its range.
    pub fn clipped(&self) -> [u32; 3] {
        self.clipped
    }
}

fn within(vector: &Vector3<f64>, range: f64) -> Vector3<f64> {
    vector.map(|value| value.clamp(-range, range))
}
