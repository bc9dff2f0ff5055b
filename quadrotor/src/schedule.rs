//! How far the integration may step.

use crate::Configuration;
use crate::control::instants::next_instant_us;

/// Longest integration step, µs.
const INTEGRATION_STEP_US: u64 = 1_000;

/// The first event after `time_us`: a sample of the control loop or a point of the integration grid.
/// Integration steps go from event to event, so none crosses a sample, wherever it is interrupted.
pub(crate) fn next_event_us(configuration: &Configuration, time_us: u64) -> u64 {
    let point_us = (time_us / INTEGRATION_STEP_US + 1) * INTEGRATION_STEP_US;
    next_instant_us(&configuration.controllers, time_us).min(point_us)
}
