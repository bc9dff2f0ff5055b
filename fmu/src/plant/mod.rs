//! The plant alone: `model` is the quadrotor without its controllers as an FMI model, `equations` what importers' own solvers
//! need of it, `commands`, `settings` and `observed` its inputs, parameters and outputs, the rest its table of variables.

mod commands;
mod equations;
mod identity;
mod inputs;
mod model;
mod observed;
mod outputs;
mod parameters;
mod settings;

pub use commands::Commands;
pub use model::{QuadrotorPlant, Run};
pub use observed::Observed;
pub use settings::{Drive, Settings};
