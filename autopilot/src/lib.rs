//! The vehicle as MAVLink sees it: a codec, one file per microservice, and [`Autopilot`], which puts them around a
//! [`Vehicle`](vehicle::Vehicle).
//!
//! ```text
//!         frames                  requests                 inputs
//!  ──────────────► service ◄──────────────► vehicle ◄──────────► quadrotor::Simulation
//!  ◄──────────────  one file per             modes, arming,       closed loop
//!         messages   microservice            set-points, landing
//! ```
//!
//! It owns no socket and reads no clock: frames and ticks of simulation time go in, messages come out, so that every
//! protocol is tested without a network, and a flight depends on nothing but its messages and their simulation times.

#![forbid(unsafe_code)]
#![cfg_attr(not(test), warn(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

mod autopilot;
pub mod codec;
pub mod file_store;
pub mod service;

pub use autopilot::{Autopilot, COMPONENT};
