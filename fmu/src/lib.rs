//! The closed-loop quadrotor and the plant alone as FMI 2.0 models of one library.
//!
//! `closed_loop` and `plant` are the models, each with its one table of names, value references, units, ranges and start values;
//! `tables` has what several models share,
//! `quantities` and `units` are what its variables measure. Everything that has to do with the interface is
//! in [`fmi`].

#![forbid(unsafe_code)]

mod closed_loop;
mod flight_error;
mod plant;
mod quantities;
mod tables;
mod units;

pub use closed_loop::ClosedLoop;
pub use flight_error::FlightError;
pub use plant::{Commands, Drive, Observed, QuadrotorPlant, Run, Settings};

fmi::export_fmi2!(ClosedLoop, QuadrotorPlant);
