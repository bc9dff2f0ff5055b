//! Units and precision of the wire.

use nalgebra::Vector3;

/// Simulation time as MAVLink's milliseconds since the start.
pub fn boot_ms(time_us: u64) -> u32 {
    (time_us / 1000) as u32
}

/// Degrees as the protocol scales them: 1e7.
pub fn scaled_degrees(degrees: f64) -> i32 {
    (degrees * 1e7).round() as i32
}

/// Metres as whole millimetres.
pub fn millimetres(metres: f64) -> i32 {
    (metres * 1e3).round() as i32
}

/// Metres per second as whole centimetres per second.
pub fn centimetres_per_second(speed_m_s: f64) -> i16 {
    (speed_m_s * 1e2).round() as i16
}

/// A vector in the precision of the protocol.
pub fn floats(vector: &Vector3<f64>) -> [f32; 3] {
    vector.data.0[0].map(|value| value as f32)
}
