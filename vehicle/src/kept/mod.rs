//! Parameters that are kept for the scripts and ground stations of PX4 and ArduPilot, and change nothing here.
//!
//! Scripts written for those autopilots set gains, filters and board settings on their way to what they are about. Each is taken,
//! kept over the flight and in parameter files, and read back; its description says that it has no effect and what has.

mod ardupilot;
mod ardupilot_devices;
mod ardupilot_flight;
mod ardupilot_simulation;
mod parameter;
mod px4;
mod px4_checks;
mod px4_devices;
mod values;

pub use parameter::{KeptParameter, Owner};
pub use values::{KeptValues, kept_parameters};
