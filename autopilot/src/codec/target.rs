//! Who a received message is for.

use mavlink::Message as _;
use mavlink::dialects::ardupilotmega::{MavComponent, MavMessage};

use super::{Frame, id};
use crate::speaker::Speaker;

/// Component id of an autopilot.
pub const COMPONENT: u8 = MavComponent::MAV_COMP_ID_AUTOPILOT1 as u8;

/// System and component; zero means all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Target {
    /// System.
    pub system: u8,
    /// Component.
    pub component: u8,
}

impl Target {
    /// All systems and components.
    pub const ALL: Self = Self { system: 0, component: 0 };

    /// Which component of this system is meant, if it is one of ours.
    pub fn speaker(self, system: u8) -> Option<Speaker> {
        (self.system == 0 || self.system == system).then(|| Speaker::of(self.component)).flatten()
    }

    /// Whether the autopilot of this system is meant.
    pub fn is_autopilot(self, system: u8) -> bool {
        (self.system == 0 || self.system == system) && (self.component == 0 || self.component == COMPONENT)
    }
}

/// The target of a frame, also where an enumeration of its message has an unknown value.
pub fn target_of(frame: &Frame) -> Target {
    let payload = frame.payload();
    let at = |system: usize| Target { system: payload.u8(system), component: payload.u8(system + 1) };
    match frame.message_id() {
        id::PARAM_REQUEST_LIST | id::PARAM_EXT_REQUEST_LIST | id::PARAM_EXT_SET => at(0),
        id::PARAM_EXT_REQUEST_READ => at(2),
        id::MISSION_REQUEST_LIST | id::MISSION_CLEAR_ALL | id::MISSION_ACK => at(0),
        id::MISSION_COUNT | id::MISSION_REQUEST | id::MISSION_REQUEST_INT | id::MISSION_SET_CURRENT => at(2),
        id::MISSION_REQUEST_PARTIAL_LIST | id::MISSION_WRITE_PARTIAL_LIST => at(4),
        id::MISSION_ITEM | id::MISSION_ITEM_INT => at(32),
        id::COMMAND_LONG | id::COMMAND_INT => at(30),
        id::COMMAND_CANCEL => at(2),
        id::PARAM_SET => at(4),
        id::SET_ATTITUDE_TARGET => at(36),
        id::GIMBAL_MANAGER_SET_ATTITUDE => at(32),
        id::GIMBAL_MANAGER_SET_PITCHYAW => at(20),
        id::GIMBAL_DEVICE_SET_ATTITUDE => at(30),
        id::SET_POSITION_TARGET_LOCAL_NED | id::SET_POSITION_TARGET_GLOBAL_INT => at(50),
        id::SET_MODE => Target { system: payload.u8(4), component: 0 },
        id::MANUAL_CONTROL => Target { system: payload.u8(10), component: 0 },
        message_id => MavMessage::parse(frame.version().into(), message_id, frame.payload_bytes()).map_or(
            Target::ALL,
            |message| Target {
                system: message.target_system_id().unwrap_or(0),
                component: message.target_component_id().unwrap_or(0),
            },
        ),
    }
}
