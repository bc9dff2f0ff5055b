//! Faults of the battery.

use serde::{Deserialize, Serialize};

/// What is wrong with the battery.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum BatteryFault {
    /// It is empty at once, and its voltage with it; the rotors turn on, as PX4's simulated ones do.
    Off,
    /// Its gauge repeats what it read last.
    Stuck,
    /// Its gauge reads [`BatteryFault::WRONG_SHARE`] of the charge that there is, and the voltage of that charge.
    Wrong,
}

impl BatteryFault {
    /// Share of the true charge that a wrong gauge reads: a full battery looks low, but not critical.
    pub const WRONG_SHARE: f64 = 0.12;
}
