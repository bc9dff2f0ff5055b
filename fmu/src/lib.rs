//! The closed-loop quadrotor as a library of FMI 2.0 and 3.0.
//!
//! `closed_loop` is the model with its one table of names, value references, units, ranges and start values;
//! `quantities` and `units` are what its variables measure. Everything that has to do with the interface is
//! in [`fmi`].

#![forbid(unsafe_code)]

mod closed_loop;
mod quantities;
mod units;

pub use closed_loop::{ClosedLoop, FlightError};

fmi::export_fmi2!(ClosedLoop);
fmi::export_fmi3!(ClosedLoop);
