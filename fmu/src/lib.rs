//! The closed-loop quadrotor, its controllers alone and its plant alone as models of one library, for FMI 2.0 and 3.0.
//!
//! `closed_loop`, `controller` and `plant` are the models, each with its one table of names, value references, units, ranges and
//! start values; `tables` has what several models share, `quantities` and `units` are what its variables measure. Everything that has to do
//! with the interface is in [`fmi`].

#![forbid(unsafe_code)]

mod closed_loop;
mod controller;
mod designs;
mod flight_error;
mod plant;
mod quantities;
mod tables;
mod units;

pub use closed_loop::ClosedLoop;
pub use controller::{
    AttitudeMeasurement, Controller, ControllerError, ControllerInputs, ControllerOutputs,
    ControllerParameters, ControllerState, MeasuredMotion, Measurements, RotorSpeedMeasurement,
};
pub use flight_error::FlightError;
pub use plant::{Commands, Drive, Observed, QuadrotorPlant, Run, Settings};

fmi::export_fmi2!(ClosedLoop, Controller, QuadrotorPlant);
fmi::export_fmi3!(ClosedLoop, Controller, QuadrotorPlant);
