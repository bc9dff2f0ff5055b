//! What is logged: PX4's topics under PX4's names, as far as this vehicle has them, and the controllers' own.
//!
//! All values are the vehicle's own, in SI units. Topics with `groundtruth` are the simulation's truth, as in PX4's
//! simulations; the others are what the vehicle believes.

mod motion;
mod sensors;
mod status;
mod table;
mod topic;

pub use table::TOPICS;
pub use topic::Topic;
