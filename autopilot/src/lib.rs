//! The vehicle as MAVLink sees it: a codec, one file per microservice, and [`Autopilot`], which puts them around a
//! [`Vehicle`](vehicle::Vehicle).
//!
//! ```text
//!         frames               claims             context
//!  ──────────────► Autopilot ─────────► service ◄─────────► vehicle, parameters, files
//!  ◄──────────────    │      registry    one file per           outbox
//!        messages     └─ order of a tick microservice
//! ```
//!
//! It owns no socket and reads no clock: frames and ticks of simulation time go in, messages come out, so that every
//! protocol is tested without a network, and a flight depends on nothing but its messages and their simulation times.

#![forbid(unsafe_code)]
#![cfg_attr(not(test), warn(clippy::unwrap_used, clippy::expect_used, clippy::panic))]

mod autopilot;
pub mod codec;
pub mod compatibility;
mod context;
pub mod envelope;
mod event_catalog;
pub mod file_store;
pub mod file_work;
pub mod log_queue;
mod outbox;
mod parameter_metadata;
mod parameters;
#[allow(deprecated)] // Clients still use what the dialect calls deprecated.
pub mod service;
pub mod speaker;
mod status_text;
mod stream;
mod turns;

pub use autopilot::Autopilot;
pub use codec::COMPONENT;
