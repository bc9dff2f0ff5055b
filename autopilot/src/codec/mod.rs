//! Between bytes and requests.
//!
//! Requests are read from the raw payload: a typed parser fails on a value that its enumerations do not know,
//! and a command that nobody knows could then not be answered.

mod attitude_target;
mod command;
mod decoder;
mod frame;
mod message;
mod mission_item;
mod parameter_value;
mod payload;
mod position_target;
mod target;

pub use attitude_target::SetAttitudeTarget;
pub use command::{Command, CommandKind};
pub use decoder::FrameDecoder;
pub use frame::{Frame, Signature, Version};
pub use message::{CommandAck, Message, floats};
pub use mission_item::MissionItemMessage;
pub use parameter_value::{Encoding, parameter_hash};
pub use payload::Payload;
pub use position_target::{SetPositionTarget, TargetPosition};
pub use target::{Target, target_of};

/// Identifiers of the messages that the vehicle reads.
pub mod id {
    /// HEARTBEAT
    pub const HEARTBEAT: u32 = 0;
    /// PING
    pub const PING: u32 = 4;
    /// SET_MODE
    pub const SET_MODE: u32 = 11;
    /// PARAM_REQUEST_READ
    pub const PARAM_REQUEST_READ: u32 = 20;
    /// PARAM_REQUEST_LIST
    pub const PARAM_REQUEST_LIST: u32 = 21;
    /// PARAM_SET
    pub const PARAM_SET: u32 = 23;
    /// MISSION_REQUEST_PARTIAL_LIST
    pub const MISSION_REQUEST_PARTIAL_LIST: u32 = 37;
    /// MISSION_WRITE_PARTIAL_LIST
    pub const MISSION_WRITE_PARTIAL_LIST: u32 = 38;
    /// MISSION_ITEM
    pub const MISSION_ITEM: u32 = 39;
    /// MISSION_REQUEST
    pub const MISSION_REQUEST: u32 = 40;
    /// MISSION_SET_CURRENT
    pub const MISSION_SET_CURRENT: u32 = 41;
    /// MISSION_REQUEST_LIST
    pub const MISSION_REQUEST_LIST: u32 = 43;
    /// MISSION_COUNT
    pub const MISSION_COUNT: u32 = 44;
    /// MISSION_CLEAR_ALL
    pub const MISSION_CLEAR_ALL: u32 = 45;
    /// MISSION_ACK
    pub const MISSION_ACK: u32 = 47;
    /// SET_GPS_GLOBAL_ORIGIN
    pub const SET_GPS_GLOBAL_ORIGIN: u32 = 48;
    /// MISSION_REQUEST_INT
    pub const MISSION_REQUEST_INT: u32 = 51;
    /// REQUEST_DATA_STREAM
    pub const REQUEST_DATA_STREAM: u32 = 66;
    /// MANUAL_CONTROL
    pub const MANUAL_CONTROL: u32 = 69;
    /// RC_CHANNELS_OVERRIDE
    pub const RC_CHANNELS_OVERRIDE: u32 = 70;
    /// MISSION_ITEM_INT
    pub const MISSION_ITEM_INT: u32 = 73;
    /// COMMAND_INT
    pub const COMMAND_INT: u32 = 75;
    /// COMMAND_LONG
    pub const COMMAND_LONG: u32 = 76;
    /// COMMAND_CANCEL
    pub const COMMAND_CANCEL: u32 = 80;
    /// SET_ATTITUDE_TARGET
    pub const SET_ATTITUDE_TARGET: u32 = 82;
    /// SET_POSITION_TARGET_LOCAL_NED
    pub const SET_POSITION_TARGET_LOCAL_NED: u32 = 84;
    /// SET_POSITION_TARGET_GLOBAL_INT
    pub const SET_POSITION_TARGET_GLOBAL_INT: u32 = 86;
    /// RADIO_STATUS
    pub const RADIO_STATUS: u32 = 109;
    /// FILE_TRANSFER_PROTOCOL
    pub const FILE_TRANSFER_PROTOCOL: u32 = 110;
    /// TIMESYNC
    pub const TIMESYNC: u32 = 111;
    /// LOG_REQUEST_LIST
    pub const LOG_REQUEST_LIST: u32 = 117;
    /// LOG_REQUEST_DATA
    pub const LOG_REQUEST_DATA: u32 = 119;
    /// LOG_ERASE
    pub const LOG_ERASE: u32 = 121;
    /// LOG_REQUEST_END
    pub const LOG_REQUEST_END: u32 = 122;
    /// SETUP_SIGNING
    pub const SETUP_SIGNING: u32 = 256;
}
