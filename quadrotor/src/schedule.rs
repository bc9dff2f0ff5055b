//! How far the integration may step.

/// Longest integration step, µs.
const INTEGRATION_STEP_US: u64 = 1_000;

/// The first point of the integration grid after `time_us`.
pub(crate) fn next_point_us(time_us: u64) -> u64 {
    (time_us / INTEGRATION_STEP_US + 1) * INTEGRATION_STEP_US
}
