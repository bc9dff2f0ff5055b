//! The log of a flight, in PX4's ULog format, which Flight Review, PlotJuggler and pyulog read.
//!
//! ```text
//!    Vehicle ──► topics ──► ulog (bytes) ──► LogFile (flushed each second) ──► LogFolder (numbers, how many; in files/)
//!                  └──────────── FlightLog: when one begins and ends ───────────────┘
//! ```
//!
//! A crash of the program, even SIGKILL, loses at most the last second: what is flushed is the system's by then. It is not
//! forced onto the disk, because the flight would wait for that; when the machine itself fails, the system's own delay
//! comes on top.
//!
//! Logging reads the vehicle and changes nothing of it: with it or without, the flight is the same.

mod flight;
mod log_file;
mod row;
mod settings;
mod topics;
mod ulog;

pub use flight::FlightLog;
pub use row::Row;
pub use settings::{LogSettings, LogStart};
pub use topics::{LogSource, TOPICS, Topic};
