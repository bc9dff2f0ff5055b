//! What can break: which unit, and how. Who is concerned reads [`Faults`]: instruments, battery and rotors.
//!
//! ```text
//!  --fault TIME:UNIT=KIND ─► ScheduledFault ─┐
//!                                            ├─► Fault ─► Vehicle::inject ─► Faults ─► instruments, battery, rotors
//!  MAV_CMD_INJECT_FAILURE ───────────────────┘
//! ```

mod battery;
mod faults;
mod injection;
mod rotors;
mod schedule;
mod sensor;

pub use battery::BatteryFault;
pub use faults::Faults;
pub use injection::{Fault, Meaningless};
pub use rotors::Rotors;
pub use schedule::ScheduledFault;
pub use sensor::{Sensor, SensorFault};
