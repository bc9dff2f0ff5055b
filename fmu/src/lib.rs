//! The closed-loop quadrotor as an FMI 2.0 co-simulation library.
//!
//! `closed_loop` is the model with its one table of names, value references, units, ranges and start values;
//! `tables` has what several models share,
//! `quantities` and `units` are what its variables measure. Everything that has to do with the interface is
//! in [`fmi`].

#![forbid(unsafe_code)]

mod closed_loop;
mod controller;
mod quantities;
mod tables;
mod units;

pub use closed_loop::{ClosedLoop, FlightError};
pub use controller::{
    AttitudeMeasurement, Controller, ControllerError, ControllerInputs, ControllerOutputs,
    ControllerParameters, ControllerState, MeasuredMotion, Measurements, RotorSpeedMeasurement,
};

fmi::export_fmi2!(ClosedLoop, Controller);
fmi::export_fmi3!(ClosedLoop, Controller);
