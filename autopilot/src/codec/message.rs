//! What the vehicle sends.

use mavlink::dialects::ardupilotmega::{COMMAND_ACK_DATA, MavMessage};
use mavlink::{MavlinkVersion, Message as _, MessageData as _};

use super::MissionItemMessage;

/// A message to be sent.
#[derive(Clone, Debug, PartialEq)]
#[allow(clippy::large_enum_variant)] // Almost all are of the large kind.
pub enum Message {
    /// One of the dialect.
    Typed(MavMessage),
    /// An answer to a command that need not be one of the dialect.
    CommandAck(CommandAck),
    /// An item of a plan, which need not be one of the dialect either.
    MissionItem(MissionItemMessage),
}

/// COMMAND_ACK, with any number of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CommandAck {
    /// MAV_CMD.
    pub command: u16,
    /// MAV_RESULT.
    pub result: u8,
    /// Percentage of a command in progress, 255 when unknown.
    pub progress: u8,
    /// Who asked: system.
    pub target_system: u8,
    /// Who asked: component.
    pub target_component: u8,
}

impl From<MavMessage> for Message {
    fn from(message: MavMessage) -> Self {
        Self::Typed(message)
    }
}

impl Message {
    /// Identifier.
    pub fn id(&self) -> u32 {
        match self {
            Self::Typed(message) => message.message_id(),
            Self::CommandAck(_) => COMMAND_ACK_DATA::ID,
            Self::MissionItem(item) => item.id(),
        }
    }

    /// Writes the payload and returns its length.
    pub(super) fn serialize(&self, version: MavlinkVersion, payload: &mut [u8; 255]) -> usize {
        match self {
            Self::Typed(message) => message.ser(version, payload),
            Self::CommandAck(ack) => ack.serialize(version, payload),
            Self::MissionItem(item) => item.serialize(version, payload),
        }
    }

    /// System and component that it is for, zero for everyone.
    pub fn target(&self) -> super::Target {
        let (system, component) = match self {
            Self::Typed(message) => (message.target_system_id(), message.target_component_id()),
            Self::CommandAck(ack) => (Some(ack.target_system), Some(ack.target_component)),
            Self::MissionItem(item) => return item.target,
        };
        super::Target { system: system.unwrap_or(0), component: component.unwrap_or(0) }
    }
}

impl CommandAck {
    fn serialize(&self, version: MavlinkVersion, payload: &mut [u8; 255]) -> usize {
        let [low, high] = self.command.to_le_bytes();
        let fields =
            [low, high, self.result, self.progress, 0, 0, 0, 0, self.target_system, self.target_component];
        for (byte, field) in payload.iter_mut().zip(fields) {
            *byte = field;
        }
        match version {
            MavlinkVersion::V1 => 3,
            MavlinkVersion::V2 => fields.iter().rposition(|field| *field != 0).map_or(1, |last| last + 1),
        }
    }
}
