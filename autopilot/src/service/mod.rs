//! One file or folder per MAVLink microservice. Each takes received messages, commands or a tick of simulation time and puts
//! answers into the outbox. None owns a socket, reads a clock or reaches the state of another; a message that several of them
//! send, such as HEARTBEAT, is a function in the file of its service.
//!
//! ```text
//!             claims: messages, commands, streams
//!  registry ◄───────────────────────────────────── service
//!     │  frame, command, tick                         │ &mut Context
//!     └──────────────────────────────────────────►────┴──► vehicle, parameters, outbox, files
//! ```
//!
//! A new service is a file with an implementation of the trait `Service`, a line here and one in the registry.

mod interface;
pub(crate) mod registry;

mod action;
mod button;
mod calibration;
mod command;
mod component_metadata;
mod custom_mode;
mod equipment;
mod estimator_source;
mod event;
mod file_transfer;
mod flight_information;
mod follow;
mod global_origin;
mod gps_input;
mod greeting;
pub(crate) mod heartbeat;
mod high_latency;
mod home_message;
mod identification;
mod landing_target;
mod log;
mod log_stream;
mod magnetometer_calibration;
mod manual_control;
mod message_interval;
mod message_request;
mod mission;
mod mission_jump;
mod motor_test;
mod notice;
mod orbit;
pub(crate) mod parameter;
mod range;
mod reboot;
mod remote_id;
mod safety_switch;
mod set_point;
mod shell;
mod standard_mode;
mod telemetry;
mod terrain;
mod time_synchronization;
pub(crate) mod traffic;
mod tune;
mod tuning_knob;
mod utm_position;
mod vision;

pub use identification::version;
pub(crate) use interface::{CommandEntry, Outcome, Progress, Repetition, Service};
