//! Between bytes and requests.
//!
//! Requests are read from the raw payload: a typed parser fails on a value that its enumerations do not know,
//! and a command that nobody knows could then not be answered.

pub mod ascii;
mod attitude_target;
pub mod checksum;
mod command;
mod command_long;
mod command_name;
mod decoder;
mod encode;
mod frame;
mod frame_check;
#[allow(deprecated)] // Clients still send what the dialect calls deprecated.
pub mod id;
mod message;
mod mission_item;
mod parameter_value;
mod payload;
mod position_target;
mod scale;
mod target;
mod true_state;

pub use attitude_target::SetAttitudeTarget;
pub use command::{Command, CommandKind};
pub use command_long::command_long;
pub use command_name::command_name;
pub use decoder::{Decoded, FrameDecoder};
pub use encode::Encoded;
pub use frame::{Frame, Signature, Version};
pub use message::{CommandAck, Message};
pub use mission_item::MissionItemMessage;
pub use parameter_value::{Encoding, parameter_hash};
pub use payload::Payload;
pub use position_target::{SetPositionTarget, TargetPosition};
pub use scale::{boot_ms, boot_us, centimetres_per_second, degrees, floats, millimetres, scaled_degrees};
pub use target::{COMPONENT, Target, target_of};
pub use true_state::hil_state_quaternion;
