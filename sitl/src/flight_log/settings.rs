//! When a log begins, and how much there may be of them.

use std::path::PathBuf;
use std::str::FromStr;

/// The sampling times of logs are multiples of it, µs, but for what is faster.
pub const GRID_US: u64 = 10_000;

/// When a log begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum LogStart {
    /// When the vehicle arms; it ends a second after it has disarmed.
    #[default]
    Arm,
    /// When the program starts; it ends with it.
    Boot,
}

impl FromStr for LogStart {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "arm" => Ok(Self::Arm),
            "boot" => Ok(Self::Boot),
            _ => Err(format!("must be `arm` or `boot`, not `{text}`")),
        }
    }
}

/// What to log and how much to keep.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LogSettings {
    /// Folder of the logs; `None`: there are none.
    pub folder: Option<PathBuf>,
    /// When one begins.
    pub start: LogStart,
    /// A log of this many bytes goes on in the next file.
    pub most_bytes: u64,
    /// More files than this are not kept: the oldest goes.
    pub most_files: usize,
}
