//! A quadrotor under a cascade of Laguerre model predictive controllers (Chipofya, Lee, Chong 2015).
//!
//! ```text
//! Inputs ─► Guidance ─► Cascade ───────────────────────► rotors_of_wrench ─► Plant ─► Outputs
//!  goal or   (shaper)    position 20 Hz → tilt θ, φ         (1)               rotor lag,   │
//!  trajectory            altitude 20 Hz → thrust F                            rigid body,  │
//!                        attitude 100 Hz → torques τ                          RK4 1 kHz    │
//!                            ▲                                                             │
//!                            └── Observer: noise, and a Kalman predictor ◄─────────────────┘
//! ```
//!
//! Each controller is a [`ControllerKind`]: Laguerre MPC, state-space MPC or DLQR on the same models and weights.
//! World frame NED, body frame FRD, SI units, angles in rad; altitude is −z. [`Simulation`] runs all of it
//! as a deterministic discrete-event simulation over integer microseconds; [`PARAMETERS`] names every
//! setting.
//!
//! # Example: the paper's flight to 5 m north, 5 m east, 10 m up
//!
//! ```
//! use quadrotor::{Configuration, Inputs, Simulation};
//!
//! # if !cfg!(feature = "shaper") { return Ok(()); }
//! let inputs = Inputs::default(); // armed, with that goal
//! let mut flight = Simulation::new(&Configuration::default(), &inputs)?;
//! flight.advance_to(15_000_000, &inputs)?;
//! let goal = inputs.reference.position_m;
//! assert!((flight.outputs().position_m - goal).norm() < 0.01);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![no_std]
#![forbid(unsafe_code)]
#![cfg_attr(not(test), warn(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

extern crate alloc;

mod activity;
mod airframe;
mod altitude_controller;
mod attitude;
mod attitude_controller;
mod attitude_target;
mod capacities;
mod cascade;
mod cascade_design;
mod configuration;
mod controller_limits;
mod error;
mod estimator;
mod governor;
mod ground;
mod guidance;
mod inputs;
pub mod limited_samples;
mod linear_models;
mod mixer;
#[cfg(feature = "shaper")]
mod motion_profile;
mod observer;
mod outputs;
mod parameter;
mod parameters;
mod plant;
mod position_controller;
mod ramp;
mod recovery;
mod reduced_attitude;
mod reference_motion;
mod rigid_body;
mod rotor_fault;
mod rotor_monitor;
mod schedule;
mod sensors;
mod setpoint;
#[cfg(feature = "shaper")]
mod shaper;
mod simulation;
mod tracking_law;
mod validation;
mod vehicle_motion;

pub use activity::{Activity, ControllerActivity};
pub use airframe::{Airframe, GRAVITY_M_S2};
pub use attitude_target::AttitudeTarget;
pub use cascade_design::{CascadeDesign, DesignReport};
pub use configuration::{
    Configuration, ControllerKind, ControllerSettings, Controllers, Environment, InitialState, Limits,
    ReferenceSettings, Sensors,
};
pub use error::{ConfigurationError, SimulationError};
pub use inputs::{Disturbance, InputSignal, Inputs, PositionReference};
/// How a controller found its last input.
pub use lmpc::Status as ControllerStatus;

pub use linear_models::{altitude_model, attitude_model, position_model};
pub use mixer::{Wrench, rotors_of_wrench, wrench_of_rotors};
pub use outputs::Outputs;
pub use parameter::{Access, Choice, Parameter, Unit};
pub use parameters::PARAMETERS;
pub use plant::Plant;
pub use rigid_body::{External, RigidBody};
pub use rotor_fault::RotorFault;
pub use rotor_monitor::RotorMonitor;
pub use simulation::{Simulation, SimulationState};
