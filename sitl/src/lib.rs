//! The program `lmpc-sitl`: links, signing files, logs, records, hardware in the loop, fleets and configuration around
//! [`autopilot::Autopilot`].
//!
//! ```text
//!            frames                  messages
//!  link ◄──────────────► fleet ◄──────────────► autopilot::Autopilot
//!  sockets, peers,        clocks, records,       no socket, no clock
//!  forwarding, signing    logs, files
//! ```
//!
//! This crate is the edge: whatever touches a socket, a file, a terminal or the wall clock is here. [`run()`] is the whole program.

#![forbid(unsafe_code)]
#![cfg_attr(not(test), warn(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

pub mod configuration;
mod failure;
pub mod files;
pub mod fleet;
pub mod flight_log;
pub mod fmu;
pub mod hil;
pub mod link;
pub mod live;
mod pace;
mod radio_port;
mod rarely;
mod ready;
pub mod record;
mod run;
mod session;
mod signals;
pub mod signing;
mod summary;
mod terminal;

pub use failure::Failure;
pub use run::run;
pub use session::Session;
pub use summary::{Flight, Summary};
