//! Telemetry: the messages that are made of the vehicle's state of now, and how often they are sent.

mod actuators;
mod attitude;
mod board;
mod estimate;
mod navigation;
mod position;
mod sensors;
mod speed_controllers;
mod status;
mod table;
mod targets;
mod truth;
mod wind;

pub use table::Telemetry;
