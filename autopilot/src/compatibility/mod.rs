//! What of PX4 and ArduPilot this vehicle takes: the tables of a page of the book, made from what the services claim, the commands
//! of plans, the modes and the parameters. Beside them stands what the originals do, which is data of ours.
//!
//! ```text
//!  registry (claims) ──┐
//!  plan commands ──────┼─► tables ──► page ──► book/src/vehicle/compatibility.md
//!  modes, parameters ──┤
//!  originals ──────────┘
//! ```

mod originals;
mod page;
mod tables;

pub use originals::{ARDUPILOT, Original, PX4};
pub use page::page;
pub use tables::{Carried, CommandRow, MessageRow, ModeRow, ParameterRow, Traffic};
pub use tables::{commands, messages, modes, parameters};
