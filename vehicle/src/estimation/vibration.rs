//! How much the accelerometers shake.

use nalgebra::Vector3;

use super::inertial::{InertialReading, PERIOD_US};

/// Motion below this frequency is flight, Hz, and what is beyond is vibration: ArduPilot's definition, as MAVLink's
/// VIBRATION message has it.
const FLIGHT_HZ: f64 = 5.0;
/// Its square is smoothed with this bandwidth, Hz.
const SMOOTHING_HZ: f64 = 2.0;

/// The measure, axis by axis.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Vibration {
    slow_m_s2: Option<Vector3<f64>>,
    square: Vector3<f64>,
}

impl Vibration {
    /// Takes a reading in.
    pub fn update(&mut self, reading: &InertialReading) {
        let force = reading.specific_force_m_s2;
        let slow = self.slow_m_s2.get_or_insert(force);
        *slow += (force - *slow) * share(FLIGHT_HZ);
        let fast = force - *slow;
        self.square += (fast.component_mul(&fast) - self.square) * share(SMOOTHING_HZ);
    }

    /// Standard deviation of the vibration, FRD, m/s².
    pub fn level_m_s2(&self) -> Vector3<f64> {
        self.square.map(libm::sqrt)
    }
}

/// What a low-pass of first order takes in with one reading: T / (T + 1/(2π f)).
fn share(frequency_hz: f64) -> f64 {
    let period_s = PERIOD_US as f64 / 1e6;
    period_s / (period_s + 1.0 / (core::f64::consts::TAU * frequency_hz))
}
