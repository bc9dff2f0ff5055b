//! A topic, and what it is sampled from.

use autopilot::{Autopilot, COMPONENT};
use vehicle::Vehicle;

use crate::flight_log::Row;

/// All sampling times are multiples of it, µs.
pub const GRID_US: u64 = 10_000;

/// What topics are sampled from.
#[derive(Clone, Copy, Debug)]
pub struct LogSource<'a> {
    /// The vehicle.
    pub vehicle: &'a Vehicle,
    /// System id that it is known by.
    pub system_id: u8,
    /// Its component id.
    pub component_id: u8,
}

impl<'a> LogSource<'a> {
    /// The vehicle of an autopilot.
    pub fn of(autopilot: &'a Autopilot) -> Self {
        Self { vehicle: autopilot.vehicle(), system_id: autopilot.system_id(), component_id: COMPONENT }
    }
}

/// A topic.
#[derive(Clone, Copy, Debug)]
pub struct Topic {
    /// Its name.
    pub name: &'static str,
    /// Its fields behind `uint64_t timestamp;`.
    pub fields: &'static str,
    /// How often it is sampled, µs: a multiple of the grid of the log.
    pub period_us: u64,
    /// Whether it is also logged whenever it changes.
    pub on_change: bool,
    /// Writes the fields.
    pub sample: fn(&LogSource<'_>, &mut Row),
}
