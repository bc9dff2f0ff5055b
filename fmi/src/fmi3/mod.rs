//! FMI 3.0 for co-simulation and model exchange: the shim between C and an instance. `functions` does what the exported functions do,
//! `instantiate` makes instances, `values` reads and sets variables, some of which are arrays; `guard` finds the instance, `lifecycle` says
//! what is legal when.

mod export;
pub mod functions;
mod guard;
pub mod instantiate;
mod lifecycle;
mod logger;
pub mod types;
mod values;
