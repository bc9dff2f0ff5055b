#![doc = include_str!("../README.md")]
//!
//! # The example's flight
//!
#![doc = include_str!("flight.svg")]
//!
//! # How it is made
//!
//! The controllers are those of Chipofya, Lee and Chong (2015).
//!
//! ```text
//!            ┌──────────────────────── ControlLoop ────────────────────────┐     ┌────── Plant ──────┐
//! Inputs ──► │ Guidance ─► position 20 Hz → tilt θ, φ                      │     │ rotor lag         │
//!  goal or   │ (shaper)    altitude 20 Hz → thrust F   ─► Mixer: inverse   │ ──► │ rotor map (1)     │ ──► Outputs
//!  trajectory│             attitude 100 Hz → torques τ    of (1)           │     │ rigid body (2)–(3)│
//!            │                 ▲                                           │     │ ground            │
//!            │                 └─ Kalman predictor (26) ◄──────────────────┼─────┼─ sensors, noise   │
//!            └─────────────────────────────────────────────────────────────┘     └───────────────────┘
//! ```
//!
//! Three types do the work, each usable by itself:
//!
//! * [`Plant`] is the vehicle without its controllers: f(x, u), and a Runge–Kutta step of it. Its four rotors may lie
//!   anywhere ([`RotorLayout`]: "+", "X", "H" or your own). Its equations hold for any [`Real`]: with [`Dual`] numbers they give
//!   exact derivatives ([`PlantState::with_seed`]). For an integrator that stops at events there are the modes and event
//!   indicators of [`Plant::derivative_in`].
//! * [`ControlLoop`] is the controllers without a vehicle: references and measurements in, rotor commands out, sampled at
//!   its own exact instants. It flies any plant or a real vehicle; `examples/fly_another_plant.rs` is an example.
//! * [`Simulation`] runs both on one schedule of integer microseconds. The same inputs give the same flight, bit for bit.
//!
//! **Controllers.** Each predicts with the loop inside it: position over the closed attitude loop ([`AttitudeLoop`]), altitude and attitude
//! over the rotors' lag. Laguerre MPC plans about a slow stabilizing feedback, under limits of tilt, its rate and acceleration, speed and
//! the thrust of each of the four rotors; all limits of a controller share one slack. References have jerk and snap, from which attitude,
//! body rate and angular acceleration follow, and mass and drag are learned in flight. A [`ControllerKind`] chooses among Laguerre MPC,
//! state-space MPC and DLQR on the same models and weights, a [`PredictionModel`] between these models and the paper's. Weights are
//! relative to the bandwidths of the loops, and [`Configuration::for_airframe`] derives limits from an airframe, so that every
//! [`AirframePreset`] flies without tuning.
//!
//! **Conventions.** World frame NED (north, east, down), body frame FRD (forward, right, down), SI units, angles in rad,
//! time in µs; altitude is −z. Rotors are numbered in the order of the airframe's layout. Numbers in parentheses are the
//! equations of the paper.
//!
//! **Settings and state.** A [`Configuration`] holds every setting, and [`PARAMETERS`] names each with its unit and range.
//! State is apart from it and is plain data to copy, save and restore: [`PlantState`], [`ControlState`],
//! [`SimulationState`].
//!
//! **Errors.** A configuration that cannot fly is refused with a [`ConfigurationError`]: a [`StabilityReport`] judges the
//! closed loop as a whole, and warns of one that flies badly. In flight, inputs or measurements
//! that are not finite are refused with a [`ControlError`] or [`SimulationError`]; the state then is the one before the
//! refused sample. Nothing panics.
//!
//! **Many flights.** A [`PreparedDesign`] is shared by all flights of one configuration, a [`DesignCache`] keeps those of several. With the
//! feature `fleet`, `Fleet` flies many vehicles on all cores, each as it flies alone.
//!
//! The crate builds without the standard library. Only the shaper, a default feature, and the feature `fleet` need it; without the shaper
//! the control loop does not allocate in flight.
//!
//! # Example: the control loop on a vehicle of your own
//!
//! ```
//! use quadrotor::{
//!     Configuration, ControlInputs, ControlLoop, InitialState, Measurement, Plant, PlantInputs, PlantState,
//!     PositionReference, Target,
//! };
//!
//! # if !cfg!(feature = "shaper") { return Ok(()); }
//! let configuration = Configuration::default();
//! // Ours stands in for it here.
//! let plant = Plant::new(&configuration.airframe, &configuration.environment);
//! let mut state = PlantState::hovering(&InitialState::default(), &configuration.airframe);
//! let measured = |state: &PlantState| Measurement {
//!     motion: state.body,
//!     rotor_speed_rad_s: state.rotor_speed_rad_s,
//! };
//!
//! let goal = PositionReference::goal([1.0, 0.0, -2.0], 0.0);
//! let inputs = ControlInputs::armed(Target::Reference(goal));
//! let mut control = ControlLoop::new(&configuration, &inputs, &mut measured(&state), 0)?;
//! for millisecond in 0..10_000 {
//!     let command_rad_s = control.advance_to(millisecond * 1_000, &inputs, &mut measured(&state))?;
//!     state = plant.step(&state, &PlantInputs::rotor_speeds(command_rad_s), 1e-3);
//! }
//! assert!((state.body.position_m - goal.position_m).norm() < 0.01);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Example: the plant under an integrator of your own
//!
//! ```
//! use quadrotor::{Airframe, Environment, InitialState, Plant, PlantInputs, PlantState, RotorLayout};
//!
//! let airframe = Airframe { layout: RotorLayout::x(), ..Airframe::default() };
//! let plant = Plant::new(&airframe, &Environment::default());
//! let mut state = PlantState::hovering(&InitialState::default(), &airframe);
//! // The front rotors a little faster than hover: it pitches up.
//! let [hover, ..] = state.rotor_speed_rad_s;
//! let inputs = PlantInputs::rotor_speeds([hover + 1.0, hover, hover, hover + 1.0]);
//! for _ in 0..2_000 {
//!     // Euler's method on f(x, u).
//!     state = state.plus(&plant.derivative(&state, &inputs), 1e-4).normalized();
//! }
//! let (_, pitch_rad, _) = state.body.rotation().euler_angles();
//! assert!(pitch_rad > 0.0);
//! ```

#![no_std]
#![forbid(unsafe_code)]
#![cfg_attr(not(test), warn(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

extern crate alloc;
// For what unit tests share with the other tests.
#[cfg(test)]
extern crate self as quadrotor;

mod attitude;
mod configuration;
mod control;
mod design;
mod finite;
#[cfg(feature = "fleet")]
mod fleet;
mod guidance;
mod inputs;
#[cfg(feature = "fleet")]
mod kinds;
#[cfg(feature = "fleet")]
mod lane_flight;
mod outputs;
mod plant;
mod plant_simulation;
mod schedule;
mod sensors;
mod simulation;
mod simulation_error;
mod simulation_state;

pub use configuration::error::ConfigurationError;
pub use configuration::nearest_name::nearest_name;
pub use configuration::parameter::{Access, Choice, Mutability, Parameter};
pub use configuration::parameters::{Configured, PARAMETERS};
pub use configuration::quantity::{Quantity, ValueRange};
pub use configuration::settings::{
    Configuration, ControllerKind, ControllerSettings, Controllers, Environment, InitialState, Limits,
    PredictionModel, ReferenceSettings, Sensors,
};
pub use configuration::unit::Unit;
pub use control::activity::{Activity, ControllerActivity};
pub use control::belief::Belief;
pub use control::control_error::ControlError;
pub use control::control_inputs::{ControlInputs, ControlLaw, ControlSignal, Target};
pub use control::control_loop::ControlLoop;
pub use control::control_state::ControlState;
pub use control::flat_attitude::FlatAttitude;
pub use control::measurement::{Instruments, Measurement};
pub use control::mixer::Mixer;
pub use control::rotor_monitor::RotorMonitor;
pub use design::attitude_loop::AttitudeLoop;
pub use design::cascade_design::{CascadeDesign, DesignReport, Redesigned};
pub use design::controller_limits::commanded_tilt_rad;
pub use design::default_bandwidths::{Bandwidths, default_bandwidths};
pub use design::design_cache::DesignCache;
pub use design::hover_loops::{HoverLoop, HoverLoops};
pub use design::limited_samples;
pub use design::linear_loop::LinearLoop;
pub use design::linear_models::{altitude_model, attitude_model, lagged_attitude_model, position_model};
pub use design::loop_problem::LoopProblem;
pub use design::prepared_design::PreparedDesign;
pub use design::side_force::{commanded_thrust_n, side_force_limit_n};
pub use design::stability::cause::Cause;
pub use design::stability::loop_stability::{LoopStability, Spread};
pub use design::stability::noise_effect::NoiseEffect;
pub use design::stability::stability_report::StabilityReport;
pub use design::stability::stability_warning::StabilityWarning;
#[cfg(feature = "fleet")]
pub use fleet::{ClosedLoopVehicle, Fleet, FleetError};
pub use guidance::attitude_target::AttitudeTarget;
pub use guidance::derivative_estimator::Derivatives;
pub use guidance::eased_limits::EasedLimits;
pub use guidance::heading::Heading;
#[cfg(feature = "shaper")]
pub use guidance::heading_shaper::HeadingShaper;
pub use guidance::motion_profile::{Motion, MotionExtremes, MotionProfile};
pub use guidance::position_reference::PositionReference;
pub use guidance::reference_plan::ReferencePlan;
#[cfg(feature = "shaper")]
pub use guidance::state_to_state::AxisLimits;
pub use guidance::streamed_velocity::StreamedVelocity;
pub use inputs::{InputSignal, Inputs};
#[cfg(feature = "fleet")]
pub use kinds::Kinds;
/// How a controller found its last input.
pub use lmpc::Status as ControllerStatus;
pub use outputs::Outputs;
pub use plant::airframe::{Airframe, GRAVITY_M_S2};
pub use plant::battery_pack::{BatteryOutput, BatteryPack, cell_voltage_v};
pub use plant::differentiation::dual::Dual;
pub use plant::differentiation::real::{Real, Valued};
pub use plant::disturbance::Disturbance;
pub use plant::dynamics::Plant;
pub use plant::events::plant_mode::PlantMode;
pub use plant::events::switch::Switch;
pub use plant::overload::Overload;
pub use plant::plant_inputs::{Actuation, PlantInputs};
pub use plant::plant_outputs::PlantOutputs;
pub use plant::plant_state::PlantState;
pub use plant::presets::AirframePreset;
pub use plant::rigid_body::{External, RigidBody};
pub use plant::rotor_aerodynamics::RotorAerodynamics;
pub use plant::rotor_fault::RotorFault;
pub use plant::rotor_layout::{Direction, Rotor, RotorLayout};
pub use plant::rotor_map::{Wrench, wrench_of_rotors};
pub use plant::rotor_spin::RotorSpin;
pub use plant_simulation::{PlantSimulation, PlantSimulationState};
pub use simulation::Simulation;
pub use simulation_error::SimulationError;
pub use simulation_state::SimulationState;
