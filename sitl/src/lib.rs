//! A quadrotor under Laguerre model predictive control that MAVLink clients fly.
//!
//! ```text
//!            frames                  requests                 inputs
//!  link ◄──────────────► service ◄──────────────► vehicle ◄──────────► quadrotor::Simulation
//!  sockets, peers,        one file per             modes, arming,       closed loop
//!  forwarding             microservice             set-points, landing
//! ```
//!
//! [`Autopilot`] is everything between the links and the closed loop. It owns no socket and reads no clock: frames and
//! ticks of simulation time go in, messages come out, so that every protocol is tested without a network, and a flight
//! depends on nothing but its messages and their simulation times. [`run()`] puts links, files and the wall clock around it.

#![forbid(unsafe_code)]
#![cfg_attr(not(test), warn(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

mod autopilot;
pub mod codec;
pub mod configuration;
pub mod estimation;
mod failure;
pub mod fault;
pub mod fence;
pub mod files;
pub mod fleet;
pub mod flight_log;
pub mod hil;
pub mod identity;
pub mod link;
mod mode;
mod pace;
pub mod parameters;
pub mod plan;
mod ready;
pub mod record;
mod run;
pub mod service;
mod session;
pub mod signing;
mod summary;
mod terminal;
pub mod vehicle;
pub mod world;

pub use autopilot::{Autopilot, COMPONENT};
pub use failure::Failure;
pub use run::run;
pub use session::Session;
pub use summary::{Flight, Summary};
