//! One file per MAVLink microservice. Each takes a received frame or a moment of simulation time, and puts answers
//! into the outbox; none owns a socket or reads a clock.

pub(crate) mod command;
pub(crate) mod component_metadata;
mod envelope;
pub(crate) mod file_transfer;
pub(crate) mod heartbeat;
#[allow(deprecated)] // Clients still ask for what the dialect calls deprecated.
pub(crate) mod identification;
pub(crate) mod log;
pub(crate) mod manual_control;
pub(crate) mod message_interval;
#[allow(deprecated)] // Clients still use what the dialect calls deprecated.
pub(crate) mod mission;
pub(crate) mod parameter;
pub(crate) mod set_point;
pub(crate) mod standard_mode;
pub(crate) mod status_text;
#[allow(deprecated)] // Clients still ask for what the dialect calls deprecated.
pub(crate) mod telemetry;
#[allow(deprecated)] // Clients still ask for what the dialect calls deprecated.
pub(crate) mod time_synchronization;

pub use envelope::{Destination, LinkProfile, Origin, Outgoing, PeerId};
