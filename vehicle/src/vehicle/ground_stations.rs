//! Which ground stations ArduPilot listens to: for the failsafe of a lost one, for overrides of channels, and for MANUAL_CONTROL.

use serde::{Deserialize, Serialize};

/// Their system ids.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct GroundStations {
    /// The first, or only one (MAV_GCS_SYSID).
    pub first: u8,
    /// The last one; less than the first: there is only that (MAV_GCS_SYSID_HI).
    pub last: u8,
}

impl Default for GroundStations {
    fn default() -> Self {
        Self { first: 255, last: 0 }
    }
}

impl GroundStations {
    /// Whether a system is one of them.
    pub fn include(&self, system: u8) -> bool {
        (self.first..=self.last.max(self.first)).contains(&system)
    }
}

#[cfg(test)]
mod tests {
    use super::GroundStations;

    /// As ArduPilot's documentation of MAV_GCS_SYSID_HI has it.
    #[test]
    fn a_last_one_below_the_first_is_none() {
        let only = GroundStations::default();
        assert!(only.include(255) && !only.include(254) && !only.include(0));
        let range = GroundStations { first: 200, last: 210 };
        for (system, included) in [(199, false), (200, true), (210, true), (211, false)] {
            assert_eq!(range.include(system), included, "{system}");
        }
    }
}
