//! What the formats of logs have in common.

use std::fmt::Debug;

use autopilot::Autopilot;
use vehicle::identity::Identity;
use vehicle::parameters::Value;
use vehicle::{Severity, Vehicle};

use super::LogSource;
use super::dataflash::DataFlashWriter;
use super::ulog::ULogWriter;

/// The formats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LogFormat {
    /// PX4's.
    ULog,
    /// ArduPilot's.
    DataFlash,
}

impl LogFormat {
    /// The one that tools of an autopilot read.
    pub fn of(identity: Identity) -> Self {
        if identity.is_ardupilot() { Self::DataFlash } else { Self::ULog }
    }

    /// A writer for a new log.
    pub fn writer(self) -> Box<dyn LogWriter> {
        match self {
            Self::ULog => Box::new(ULogWriter::new()),
            Self::DataFlash => Box::new(DataFlashWriter::new()),
        }
    }
}

/// Makes the bytes of one log. It remembers what it has written.
pub trait LogWriter: Debug {
    /// What stands before the data.
    fn begin(&mut self, autopilot: &Autopilot, parameters: &[Value]) -> Vec<u8>;

    /// A parameter with its value.
    fn parameter(&mut self, into: &mut Vec<u8>, time_us: u64, id: &str, value: Value);

    /// A line for the pilot.
    fn text(&mut self, into: &mut Vec<u8>, time_us: u64, severity: Severity, line: &str);

    /// Whether something is due now although the time is not on the grid.
    fn is_due_between(&self, _vehicle: &Vehicle) -> bool {
        false
    }

    /// What is due now.
    fn sample(&mut self, into: &mut Vec<u8>, source: &LogSource<'_>);

    /// A mark between what has been written to the disk and what comes; data of a duration, µs, may be missing before it.
    fn mark(&self, into: &mut Vec<u8>, time_us: u64, dropped_us: Option<u64>);
}
