//! A closed loop or a plant from elsewhere, in place of ours: what it is told, and what it shows.

mod description;
mod driven;
mod model;

pub use description::{ForeignDescription, ForeignRole};
pub use driven::{Driven, drive};
pub use model::{Demand, ForeignModel, ForeignMotion};
