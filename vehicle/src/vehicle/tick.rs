//! The tick of a vehicle.

/// Length of a tick, µs: requests take effect, and telemetry is sampled, on this grid of simulation time.
pub const TICK_US: u64 = 1_000;

/// The same, s.
pub const TICK_S: f64 = TICK_US as f64 / 1e6;
