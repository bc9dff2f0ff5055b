//! The log of a flight: in PX4's ULog format, or in ArduPilot's DataFlash format where that autopilot is shown.
//!
//! ```text
//!    Vehicle ──► source ─┬─► ulog: topics ───────────────┐
//!                        └─► dataflash: messages ────────┴─► LogFile (flushed each second) ──► LogFolder (numbers, how many; in files/)
//!                  FlightLog: when one begins, rests and ends ──────┘
//! ```
//!
//! A crash of the program, even SIGKILL, loses at most the last second: what is flushed is the system's by then. It is not
//! forced onto the disk, because the flight would wait for that; when the machine itself fails, the system's own delay
//! comes on top.
//!
//! Logging reads the vehicle and changes nothing of it: with it or without, the flight is the same.

mod dataflash;
mod flight;
mod format;
mod log_file;
mod settings;
mod source;
mod streamed;
mod ulog;

pub use dataflash::{Field, MESSAGES, Message};
pub use flight::FlightLog;
pub use format::LogFormat;
pub use settings::{LogSettings, LogStart};
pub use source::LogSource;
pub use streamed::StreamedLog;
pub use ulog::{Row, TOPICS, Topic};
