//! What ArduPilot's logs hold, and when they are written.

use serde::{Deserialize, Serialize};

/// Parameters of logs in ArduPilot's convention.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct LogConduct {
    /// LOG_BITMASK: what is written, a bit each.
    pub bits: u32,
    /// LOG_DISARMED: 0 writes while armed; other values write always.
    pub disarmed: u8,
    /// LOG_FILE_DSRMROT: whether each flight has a file of its own; otherwise there is one for each boot.
    pub rotates: bool,
    /// PRX_LOG_RAW: whether what the proximity sensor measures is written as it comes, too.
    #[serde(default)]
    pub proximity_raw: bool,
}

/// ArduCopter's: everything but the fast rates; while armed; one file for each boot.
impl Default for LogConduct {
    fn default() -> Self {
        Self { bits: 176_126, disarmed: 0, rotates: false, proximity_raw: false }
    }
}
