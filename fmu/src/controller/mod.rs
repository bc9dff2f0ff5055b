//! The controllers alone: `model` is the control loop as an FMI model, `measured_motion` what it measures, `predicted_rotors` what it takes
//! for the speeds of rotors that nobody measures, the rest its table of variables.

mod error;
mod identity;
mod inputs;
mod measured_motion;
mod measurement;
mod model;
mod outputs;
mod parameters;
mod predicted_rotors;

pub use error::ControllerError;
pub use inputs::ControllerInputs;
pub use measured_motion::MeasuredMotion;
pub use measurement::{AttitudeMeasurement, Measurements, RotorSpeedMeasurement};
pub use model::{Controller, ControllerOutputs, ControllerState};
pub use parameters::ControllerParameters;
