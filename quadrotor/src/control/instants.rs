//! When a control loop samples.

use crate::Controllers;

/// From one look at the inputs to the next, µs: arming, for one, does not wait for a controller's sample.
const INPUT_PERIOD_US: u64 = 1_000;

/// The latest time that a saved state may have, µs: nine thousand years, so that what is added to it does not overflow.
pub(crate) const LATEST_US: u64 = u64::MAX / 64;

/// Whether a clock of `period_us` ticks at `time_us`.
pub(crate) fn ticks(time_us: u64, period_us: u64) -> bool {
    time_us.is_multiple_of(period_us)
}

/// Whether the loop samples at `time_us`.
pub(crate) fn is_instant(controllers: &Controllers, time_us: u64) -> bool {
    periods_us(controllers).into_iter().any(|period_us| ticks(time_us, period_us))
}

/// The first instant after `time_us`.
pub(crate) fn next_instant_us(controllers: &Controllers, time_us: u64) -> u64 {
    periods_us(controllers)
        .into_iter()
        .map(|period_us| (time_us / period_us + 1) * period_us)
        .fold(u64::MAX, u64::min)
}

fn periods_us(controllers: &Controllers) -> [u64; 4] {
    [
        INPUT_PERIOD_US,
        controllers.position.sample_time_us,
        controllers.altitude.sample_time_us,
        controllers.attitude.sample_time_us,
    ]
}
