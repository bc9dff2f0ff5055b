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

mod attitude;
mod configuration;
mod control;
mod design;
mod guidance;
mod inputs;
mod outputs;
mod plant;
mod schedule;
mod sensors;
mod simulation;
mod simulation_error;
mod simulation_state;

pub use configuration::error::ConfigurationError;
pub use configuration::parameter::{Access, Choice, Parameter, Unit};
pub use configuration::parameters::PARAMETERS;
pub use configuration::settings::{
    Configuration, ControllerKind, ControllerSettings, Controllers, Environment, InitialState, Limits,
    ReferenceSettings, Sensors,
};
pub use control::activity::{Activity, ControllerActivity};
pub use control::control_error::ControlError;
pub use control::control_inputs::{ControlInputs, ControlLaw, ControlSignal, Target};
pub use control::control_loop::ControlLoop;
pub use control::control_state::ControlState;
pub use control::measurement::{Instruments, Measurement};
pub use control::mixer::Mixer;
pub use control::rotor_monitor::RotorMonitor;
pub use design::cascade_design::{CascadeDesign, DesignReport, Redesigned};
pub use design::limited_samples;
pub use design::linear_models::{altitude_model, attitude_model, position_model};
pub use guidance::attitude_target::AttitudeTarget;
pub use guidance::position_reference::PositionReference;
pub use inputs::{InputSignal, Inputs};
/// How a controller found its last input.
pub use lmpc::Status as ControllerStatus;
pub use outputs::Outputs;
pub use plant::airframe::{Airframe, GRAVITY_M_S2};
pub use plant::disturbance::Disturbance;
pub use plant::dynamics::Plant;
pub use plant::plant_inputs::{Actuation, PlantInputs};
pub use plant::plant_state::PlantState;
pub use plant::rigid_body::{External, RigidBody};
pub use plant::rotor_fault::RotorFault;
pub use plant::rotor_layout::{Direction, Rotor, RotorLayout};
pub use plant::rotor_map::{Wrench, wrench_of_rotors};
pub use simulation::Simulation;
pub use simulation_error::SimulationError;
pub use simulation_state::SimulationState;
