//! How a run ended.

use std::time::Duration;

use crate::fleet::Loss;

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Duration by the wall clock.
    pub wall: Duration,
    /// The flight of each vehicle.
    pub flights: Vec<Flight>,
    /// Vehicles whose simulation failed before the end.
    pub losses: Vec<Loss>,
    /// What is missing from files, a sentence each.
    pub incomplete: Vec<String>,
}

/// How the flight of a vehicle ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Flight {
    /// System id.
    pub system_id: u8,
    /// Simulated time, µs.
    pub time_us: u64,
    /// Digest of the flight, see [`crate::record::Digest`].
    pub digest: u64,
}
