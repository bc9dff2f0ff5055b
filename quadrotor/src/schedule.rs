//! How far the integration may step.

/// Longest integration step, µs.
const INTEGRATION_STEP_US: u64 = 1_000;

/// The first point of the integration grid after `time_us`.
pub(crate) fn next_point_us(time_us: u64) -> u64 {
    (time_us / INTEGRATION_STEP_US + 1) * INTEGRATION_STEP_US
}

#[cfg(test)]
mod tests {
    use super::next_point_us;

    #[test]
    fn points_are_a_millisecond_apart_and_later_than_now() {
        for (time_us, next_us) in
            [(0, 1_000), (1, 1_000), (999, 1_000), (1_000, 2_000), (12_345_678, 12_346_000)]
        {
            assert_eq!(next_point_us(time_us), next_us);
        }
    }
}
