//! A quadrotor under a cascade of Laguerre model predictive controllers.

#![no_std]
#![forbid(unsafe_code)]
#![cfg_attr(not(test), warn(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

mod airframe;
mod altitude_controller;
mod attitude;
mod attitude_controller;
mod cascade;
mod cascade_design;
mod configuration;
mod error;
mod governor;
mod ground;
mod guidance;
mod inputs;
mod linear_models;
mod mixer;
#[cfg(feature = "shaper")]
mod motion_profile;
mod outputs;
mod parameters;
mod plant;
mod position_controller;
mod ramp;
mod reference_motion;
mod rigid_body;
mod schedule;
mod setpoint;
#[cfg(feature = "shaper")]
mod shaper;
mod simulation;
mod validation;

pub use airframe::{Airframe, GRAVITY_M_S2};
pub use cascade_design::{CascadeDesign, DesignReport};
pub use configuration::{
    Configuration, ControllerSettings, Controllers, Environment, InitialState, Limits, ReferenceSettings,
};
pub use error::{ConfigurationError, SimulationError};
pub use inputs::{Disturbance, InputSignal, Inputs, PositionReference};
pub use linear_models::{altitude_model, attitude_model, position_model};
pub use mixer::{Wrench, rotors_of_wrench, wrench_of_rotors};
pub use outputs::Outputs;
pub use parameters::{Access, PARAMETERS, Parameter, Unit};
pub use plant::Plant;
pub use rigid_body::{External, RigidBody};
pub use simulation::{Simulation, SimulationState};
