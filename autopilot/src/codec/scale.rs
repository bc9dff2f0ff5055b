//! Units and precision of the wire.

use nalgebra::Vector3;

/// Simulation time as MAVLink's milliseconds since the start: `time_boot_ms`. The field has 32 bits, so it starts again at zero
/// every 2³² ms (49.7 days), as on any autopilot. SYSTEM_TIME has the time of day without a limit.
pub fn boot_ms(time_us: u64) -> u32 {
    wrapped(time_us / 1000)
}

/// Simulation time as microseconds in a field of 32 bits, which starts again at zero every 2³² µs (71.6 minutes).
pub fn boot_us(time_us: u64) -> u32 {
    wrapped(time_us)
}

/// The lower 32 bits.
fn wrapped(count: u64) -> u32 {
    (count & u64::from(u32::MAX)) as u32
}

/// Degrees as the protocol scales them: 1e7.
pub fn scaled_degrees(degrees: f64) -> i32 {
    (degrees * 1e7).round() as i32
}

/// Degrees from those of the protocol.
pub fn degrees(scaled: i32) -> f64 {
    f64::from(scaled) / 1e7
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

#[cfg(test)]
mod tests {
    use super::{boot_ms, boot_us};

    #[test]
    fn times_of_32_bits_start_again_and_their_differences_stay_right() {
        const YEAR_US: u64 = 365 * 86_400 * 1_000_000;
        assert_eq!((boot_ms(1_999), boot_us(1_999)), (1, 1_999));
        for time_us in [0, 4_294_967_295_000, 4_294_967_296_000, YEAR_US] {
            let later_us = time_us + 20_000;
            assert_eq!(boot_ms(later_us).wrapping_sub(boot_ms(time_us)), 20, "{time_us}");
            assert_eq!(boot_us(later_us).wrapping_sub(boot_us(time_us)), 20_000, "{time_us}");
        }
        assert_eq!(boot_ms(4_294_967_296_000), 0);
    }
}
