//! A topic, and how often it is sampled.

use super::super::row::Row;
use crate::flight_log::LogSource;

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
