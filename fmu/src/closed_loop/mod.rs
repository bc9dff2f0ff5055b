//! The closed loop: `model` is the quadrotor with its controllers as an FMI model, the rest its table of variables.

mod identity;
mod inputs;
mod model;
mod outputs;
mod parameters;

pub use model::ClosedLoop;
