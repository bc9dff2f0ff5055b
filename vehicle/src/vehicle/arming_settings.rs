//! What is checked before arming.

use serde::{Deserialize, Serialize};

/// ArduPilot's parameters of arming.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct ArmingSettings {
    /// Checks that are made, as the parameter adds them up; 0: none (ARMING_CHECK).
    pub checks: i32,
    /// Checks that are skipped, likewise; −1: all (ARMING_SKIPCHK).
    pub skipped: i32,
    /// Mission items that are required, as the parameter adds them up (ARMING_MIS_ITEMS).
    pub required_items: u32,
}

impl Default for ArmingSettings {
    fn default() -> Self {
        Self { checks: 1, skipped: 0, required_items: 0 }
    }
}

impl ArmingSettings {
    /// Whether nothing is checked that an expert may leave out.
    pub fn skips_all(&self) -> bool {
        self.checks == 0 || self.skipped == -1
    }
}
