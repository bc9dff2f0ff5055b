//! When the controllers sample and how far the integration may step.

use crate::Configuration;

/// Longest integration step, µs.
const INTEGRATION_STEP_US: u64 = 1_000;

/// Whether a clock of `period_us` ticks at `time_us`.
pub(crate) fn ticks(time_us: u64, period_us: u64) -> bool {
    time_us.is_multiple_of(period_us)
}

/// The first event after `time_us`: a sample of a controller or a point of the integration grid.
/// Integration steps go from event to event, so none crosses a sample, wherever it is interrupted.
pub(crate) fn next_event_us(configuration: &Configuration, time_us: u64) -> u64 {
    let controllers = &configuration.controllers;
    [
        INTEGRATION_STEP_US,
        controllers.position.sample_time_us,
        controllers.altitude.sample_time_us,
        controllers.attitude.sample_time_us,
    ]
    .into_iter()
    .map(|period_us| (time_us / period_us + 1) * period_us)
    .fold(u64::MAX, u64::min)
}
