//! Errors that a user gives to instruments in flight, beside those of the simulated parts and beside faults.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::gps::{GpsFix, LATENCY_US, RATE_HZ};
use super::jamming::Jamming;
use super::noise::{Channel, Noise};
use crate::fault::{Fault, Faults, Sensor, SensorFault};

/// Three axes of an instrument, or of a place.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Triple {
    /// Forwards, or north.
    pub x: f64,
    /// To the right, or east.
    pub y: f64,
    /// Down, or up for a place.
    pub z: f64,
}

impl Triple {
    fn vector(self) -> Vector3<f64> {
        Vector3::new(self.x, self.y, self.z)
    }
}

/// Errors of instruments. By default there are none.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SensorErrors {
    /// Which instruments say nothing, or are not listened to.
    pub switches: SensorSwitches,
    /// Standard deviation of additional noise of the accelerometers, m/s².
    pub accelerometer_noise_m_s2: f64,
    /// Additional offset of the accelerometers, m/s².
    pub accelerometer_bias_m_s2: Triple,
    /// What all accelerometers read instead, m/s²; 0: they read.
    pub accelerometer_reads_m_s2: f64,
    /// Standard deviation of additional noise of the gyroscopes, °/s.
    pub gyroscope_noise_deg_s: f64,
    /// Additional offset of the gyroscopes, rad/s.
    pub gyroscope_bias_rad_s: Triple,
    /// Standard deviation of additional noise of the barometer, m.
    pub barometer_noise_m: f64,
    /// How fast the barometer's height drifts, m/s.
    pub barometer_drift_m_s: f64,
    /// By how much the barometer's height is off, m.
    pub barometer_glitch_m: f64,
    /// Standard deviation of additional noise of the magnetometer, mGauss.
    pub magnetometer_noise_mgauss: f64,
    /// Additional offset of the magnetometer, mGauss.
    pub magnetometer_offset_mgauss: Triple,
    /// By how much GPS is off: degrees of latitude, of longitude, and metres upwards.
    pub gps_glitch: Triple,
    /// Whether GPS is jammed.
    pub gps_jammed: bool,
    /// Standard deviation of additional noise of GPS heights, m.
    pub gps_noise_m: f64,
    /// Satellites that the receiver says it uses.
    pub gps_satellites: u8,
    /// Kind of fix that the receiver tells, by MAVLink's number; below that of a place in three dimensions it has none.
    pub gps_fix_type: u8,
    /// Fixes per second.
    pub gps_rate_hz: u8,
    /// Time from a fix to its message, ms.
    pub gps_latency_ms: u16,
}

/// Which instruments say nothing, or are not listened to.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SensorSwitches {
    /// Whether the GPS receiver works.
    pub gps: bool,
    /// Kind of GPS receiver, by ArduPilot's number (GPS1_TYPE).
    pub gps_kind: u8,
    /// What of GPS is used (EKF2_GPS_CTRL): nothing without the lowest bit.
    pub gps_control: f64,
    /// Whether the barometer is used (EKF2_BARO_CTRL).
    pub barometer_control: bool,
    /// Whether the magnetometer is used (EKF2_MAG_TYPE: 5 is not at all).
    pub magnetometer: MagnetometerUse,
    /// Whether the estimator starts again by a receiver that goes on contradicting the inertial unit (FS_VIBE_ENABLE).
    pub starts_again: bool,
    /// Whether the barometer says nothing.
    pub barometer_off: bool,
    /// Whether the barometer repeats itself.
    pub barometer_frozen: bool,
    /// Whether the magnetometer says nothing.
    pub magnetometer_off: bool,
    /// Whether the accelerometers say nothing.
    pub accelerometer_off: bool,
    /// Whether the gyroscopes say nothing.
    pub gyroscope_off: bool,
}

/// How the magnetometer is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum MagnetometerUse {
    /// All axes, or the heading, as fits.
    #[default]
    Automatic,
    /// Asked for the heading only; the estimator here decides itself.
    Heading,
    /// Not at all.
    None,
    /// Asked for at the start only; the estimator here decides itself.
    AtStart,
}

/// Kinds of GPS receivers, by ArduPilot's numbers: none, whichever there is, and one that sends GPS_INPUT. All others are simulated.
const NONE: u8 = 0;
const AUTOMATIC: u8 = 1;
const MESSAGES: u8 = 14;
/// Satellites of the simulated receiver.
const SATELLITES: u8 = 12;
/// A degree of latitude, m.
const DEGREE_M: f64 = 111_319.5;

/// GPS_FIX_TYPE_3D_FIX.
pub const FIX_3D: u8 = 3;

impl Default for SensorErrors {
    fn default() -> Self {
        Self {
            switches: SensorSwitches::default(),
            accelerometer_noise_m_s2: 0.0,
            accelerometer_bias_m_s2: Triple::default(),
            accelerometer_reads_m_s2: 0.0,
            gyroscope_noise_deg_s: 0.0,
            gyroscope_bias_rad_s: Triple::default(),
            barometer_noise_m: 0.0,
            barometer_drift_m_s: 0.0,
            barometer_glitch_m: 0.0,
            magnetometer_noise_mgauss: 0.0,
            magnetometer_offset_mgauss: Triple::default(),
            gps_glitch: Triple::default(),
            gps_jammed: false,
            gps_noise_m: 0.0,
            gps_satellites: SATELLITES,
            gps_fix_type: FIX_3D,
            gps_rate_hz: RATE_HZ,
            gps_latency_ms: (LATENCY_US / 1000) as u16,
        }
    }
}

impl Default for SensorSwitches {
    fn default() -> Self {
        Self {
            gps: true,
            gps_kind: AUTOMATIC,
            gps_control: 7.0,
            barometer_control: true,
            magnetometer: MagnetometerUse::Automatic,
            starts_again: true,
            barometer_off: false,
            barometer_frozen: false,
            magnetometer_off: false,
            accelerometer_off: false,
            gyroscope_off: false,
        }
    }
}

impl SensorErrors {
    /// Whether they change readings: ideal sensors have none, and can only be silent.
    pub fn need_readings(&self) -> bool {
        let quiet = Self {
            switches: SensorSwitches { barometer_frozen: self.switches.barometer_frozen, ..self.switches },
            gps_satellites: self.gps_satellites,
            gps_fix_type: self.gps_fix_type.max(FIX_3D),
            gps_rate_hz: self.gps_rate_hz,
            gps_latency_ms: self.gps_latency_ms,
            ..Self::default()
        };
        *self != quiet || self.switches.barometer_frozen
    }
}

impl SensorSwitches {
    /// Whether fixes come from outside, by GPS_INPUT, in place of those of the simulated receiver.
    pub fn gps_comes_by_message(&self) -> bool {
        self.gps_kind == MESSAGES
    }

    fn gps_works(&self) -> bool {
        match self.gps_kind {
            NONE => false,
            MESSAGES => true,
            _ => self.gps,
        }
    }

    /// The faults with those of the switches: a unit that is broken already stays as it is.
    pub fn with(&self, mut faults: Faults) -> Faults {
        let gps_is_used = self.gps_control as u32 & 1 != 0;
        let compass_is_used = self.magnetometer != MagnetometerUse::None;
        for (sensor, silent, fault) in [
            (Sensor::Gps, !self.gps_works() || !gps_is_used, SensorFault::Off),
            (Sensor::Barometer, self.barometer_off || !self.barometer_control, SensorFault::Off),
            (Sensor::Barometer, self.barometer_frozen, SensorFault::Stuck),
            (Sensor::Magnetometer, self.magnetometer_off || !compass_is_used, SensorFault::Off),
            (Sensor::Accelerometer, self.accelerometer_off, SensorFault::Off),
            (Sensor::Gyroscope, self.gyroscope_off, SensorFault::Off),
        ] {
            if silent && faults.sensor(sensor).is_none() {
                faults.set(&Fault::Sensor(sensor, Some(fault)));
            }
        }
        faults
    }
}

/// Adds the errors to readings. Their noise has a stream of its own: without errors nothing is drawn.
#[derive(Clone, Debug)]
pub struct ErrorSource {
    noise: Noise,
    drift_m: f64,
    jamming: Jamming,
}

impl ErrorSource {
    /// Under the seed of the run.
    pub fn new(seed: u64) -> Self {
        Self { noise: Noise::new(seed, Channel::Error), drift_m: 0.0, jamming: Jamming::default() }
    }

    fn spread(&mut self, deviation: f64) -> Vector3<f64> {
        if deviation > 0.0 { self.noise.vector(deviation) } else { Vector3::zeros() }
    }

    /// Body rates, rad/s.
    pub fn rate(&mut self, errors: &SensorErrors, rate_rad_s: Vector3<f64>) -> Vector3<f64> {
        let noise = self.spread(errors.gyroscope_noise_deg_s.to_radians());
        rate_rad_s + errors.gyroscope_bias_rad_s.vector() + noise
    }

    /// Specific force, m/s².
    pub fn force(&mut self, errors: &SensorErrors, force_m_s2: Vector3<f64>) -> Vector3<f64> {
        if errors.accelerometer_reads_m_s2 != 0.0 {
            return Vector3::repeat(errors.accelerometer_reads_m_s2);
        }
        let noise = self.spread(errors.accelerometer_noise_m_s2);
        force_m_s2 + errors.accelerometer_bias_m_s2.vector() + noise
    }

    /// By how much the barometer's height is off, m. `dt_s` is the time since the reading before.
    pub fn height_m(&mut self, errors: &SensorErrors, dt_s: f64) -> f64 {
        self.drift_m = if errors.barometer_drift_m_s == 0.0 {
            0.0
        } else {
            self.drift_m + errors.barometer_drift_m_s * dt_s
        };
        let noise =
            if errors.barometer_noise_m > 0.0 { self.noise.normal(errors.barometer_noise_m) } else { 0.0 };
        errors.barometer_glitch_m + self.drift_m + noise
    }

    /// Magnetic field, gauss.
    pub fn field(&mut self, errors: &SensorErrors, field_gauss: Vector3<f64>) -> Vector3<f64> {
        let noise = self.spread(errors.magnetometer_noise_mgauss / 1e3);
        field_gauss + errors.magnetometer_offset_mgauss.vector() / 1e3 + noise
    }

    /// A fix, at a latitude in degrees. `None` if it is lost.
    pub fn fix(&mut self, errors: &SensorErrors, mut fix: GpsFix, latitude_deg: f64) -> Option<GpsFix> {
        let Triple { x: latitude, y: longitude, z: up_m } = errors.gps_glitch;
        let noise = if errors.gps_noise_m > 0.0 { self.noise.normal(errors.gps_noise_m) } else { 0.0 };
        let east_m = longitude * DEGREE_M * libm::cos(latitude_deg.to_radians());
        fix.position_m += Vector3::new(latitude * DEGREE_M, east_m, -up_m - noise);
        fix.satellites = errors.gps_satellites;
        if errors.gps_fix_type < FIX_3D {
            return None;
        }
        if errors.gps_jammed { self.jamming.disturb(fix, &mut self.noise) } else { Some(fix) }
    }
}
