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
    /// Whether its place must be known in every mode (ARMING_NEED_LOC).
    pub needs_place: bool,
    /// Whether the safety switch is on at the start (BRD_SAFETY_DEFLT).
    pub is_safe_at_the_start: bool,
}

impl Default for ArmingSettings {
    fn default() -> Self {
        Self { checks: 1, skipped: 0, required_items: 0, needs_place: false, is_safe_at_the_start: false }
    }
}

impl ArmingSettings {
    /// Whether nothing is checked that an expert may leave out.
    pub fn skips_all(&self) -> bool {
        self.checks == 0 || self.skipped == -1
    }
}
