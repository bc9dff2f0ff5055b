//! FMI 2.0 for co-simulation and model exchange: the shim between C and an instance. `functions` does what the 44 exported functions do,
//! `guard` finds the instance, `lifecycle` says what is legal when.

mod export;
pub mod functions;
mod guard;
mod instantiate;
mod lifecycle;
mod logger;
mod status;
pub mod types;
