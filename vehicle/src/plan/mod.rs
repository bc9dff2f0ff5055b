//! Plans: what clients upload item by item and the vehicle keeps.
//!
//! ```text
//!  item ──► check of its kind ──► plan of its kind: the items, for downloads, ids and files
//!                                   │ compile
//!                                   ▼
//!                                 steps of a program, zones, rally points ──► vehicle
//! ```
//!
//! [`check`] decides what is taken, item by item as they come and then the plan as a whole; a plan that is refused leaves the
//! old one in force. [`compile`] knows what items mean (MAV_CMD, degrees, parameters that were not given); behind it everything
//! is typed and in SI units.

mod altitude;
mod change_speed;
pub mod check;
#[allow(missing_docs)] // The names of the numbers are their documentation.
pub mod command;
pub mod compile;
mod equipment_commands;
mod fault;
pub mod file;
mod file_fault;
mod item;
pub mod item_search;
mod kind;
mod look;
mod mission_command;
mod place;
mod program;
pub mod return_path;
mod site;
pub mod step;
mod store;
mod time_of_day;
mod zones;

pub use altitude::Altitude;
pub use change_speed::{ChangeSpeed, SpeedKind, SpeedTarget};
pub use fault::{FaultCode, PlanFault};
pub use file_fault::PlanFileFault;
pub use item::MissionItem;
pub use kind::PlanKind;
pub use look::Look;
pub use mission_command::command_numbers;
pub use place::Place;
pub use program::{Program, ProgramStep};
pub use site::{Site, frame, is_above_ground, is_global};
pub use store::{Plan, Plans};
pub use time_of_day::TimeOfDay;
pub use zones::zones;
