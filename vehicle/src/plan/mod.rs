//! Plans: what clients upload item by item and the vehicle keeps.
//!
//! ```text
//!  item ──► check of its kind ──► plan of its kind ──► vehicle
//! ```
//!
//! [`check`] decides what is taken, item by item as they come and then the plan as a whole; a plan that is refused leaves the
//! old one in force.

pub mod check;
mod fault;
pub mod file;
mod item;
mod kind;
mod site;
mod store;
mod zones;

pub use fault::{FaultCode, PlanFault};
pub use item::{MissionItem, command};
pub use kind::PlanKind;
pub use site::{Place, Site, frame, is_global};
pub use store::{Plan, Plans};
pub use zones::zones;
