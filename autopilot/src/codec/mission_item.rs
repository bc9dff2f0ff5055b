//! MISSION_ITEM_INT and MISSION_ITEM.

use mavlink::MavlinkVersion;
use vehicle::plan::{MissionItem, frame};

use super::command::is_local;
use super::{Frame, Payload, Target, id};

/// An item on its way, with any command and any frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MissionItemMessage {
    /// Number of the item in its plan.
    pub sequence: u16,
    /// The item.
    pub item: MissionItem,
    /// Whether it is the one that is flown now.
    pub current: u8,
    /// MAV_MISSION_TYPE; any number.
    pub kind: u8,
    /// Who it is for.
    pub target: Target,
    /// Whether its place is scaled integers (MISSION_ITEM_INT) or floats (the older MISSION_ITEM).
    pub int: bool,
}

/// How many of its units a degree or a metre is in a MISSION_ITEM_INT.
fn scale(frame: u8) -> f64 {
    match frame {
        frame::MISSION => 1.0,
        local if is_local(local) => 1e4,
        _ => 1e7,
    }
}

impl MissionItemMessage {
    /// Bytes of a payload with nothing cut off.
    pub const LENGTH: usize = 38;

    /// Reads either message.
    pub fn read(message: &Frame) -> Option<Self> {
        match message.message_id() {
            id::MISSION_ITEM_INT => Some(Self::of_payload(message.payload(), true)),
            id::MISSION_ITEM => Some(Self::of_payload(message.payload(), false)),
            _ => None,
        }
    }

    /// Reads the payload of either message.
    pub fn of_payload(payload: Payload<'_>, int: bool) -> Self {
        let frame = payload.u8(34);
        let place = |offset: usize| match payload.i32(offset) {
            _ if !int => f64::from(payload.f32(offset)),
            // What stands for "not given", and what a cast makes of NaN.
            i32::MAX | i32::MIN => f64::NAN,
            value => f64::from(value) / scale(frame),
        };
        let item = MissionItem {
            frame,
            command: payload.u16(30),
            parameters: payload.reals(0),
            position: [place(16), place(20), f64::from(payload.f32(24))],
            autocontinue: payload.u8(36) != 0,
        };
        Self {
            sequence: payload.u16(28),
            item,
            current: payload.u8(35),
            kind: payload.u8(37),
            target: Target { system: payload.u8(32), component: payload.u8(33) },
            int,
        }
    }

    /// Identifier of the message.
    pub fn id(&self) -> u32 {
        if self.int { id::MISSION_ITEM_INT } else { id::MISSION_ITEM }
    }

    /// The payload of MAVLink 2 with nothing cut off: [`Self::LENGTH`] bytes.
    pub fn payload(&self) -> Vec<u8> {
        let item = &self.item;
        let float = |value: f64| (value as f32).to_le_bytes();
        let place = |value: f64| {
            if !self.int {
                return float(value);
            }
            let integer = if value.is_nan() { i32::MAX } else { (value * scale(item.frame)).round() as i32 };
            integer.to_le_bytes()
        };
        let [x, y, z] = item.position;
        let mut bytes = item.parameters.map(float).concat();
        bytes.extend([place(x), place(y), float(z)].concat());
        bytes.extend([self.sequence.to_le_bytes(), item.command.to_le_bytes()].concat());
        bytes.extend([self.target.system, self.target.component, item.frame, self.current]);
        bytes.extend([u8::from(item.autocontinue), self.kind]);
        bytes
    }

    /// Writes the payload and returns its length.
    pub(super) fn serialize(&self, version: MavlinkVersion, payload: &mut [u8; 255]) -> usize {
        let mut bytes = self.payload();
        if version == MavlinkVersion::V2 {
            let used = bytes.iter().rposition(|byte| *byte != 0).map_or(1, |last| last + 1);
            bytes.truncate(used);
        } else {
            // The kind is an extension.
            bytes.pop();
        }
        for (place, byte) in payload.iter_mut().zip(&bytes) {
            *place = *byte;
        }
        bytes.len()
    }
}

#[cfg(test)]
mod tests {
    use mavlink::dialects::ardupilotmega::{
        MISSION_ITEM_INT_DATA, MavCmd, MavFrame, MavMessage, MavMissionType,
    };

    use super::{MissionItemMessage, Target};
    use crate::codec::{Frame, Message, Version};
    use vehicle::plan::MissionItem;

    fn message(int: bool, frame: u8, position: [f64; 3]) -> MissionItemMessage {
        let parameters = [1.5, f64::NAN, -2.0, 0.0];
        MissionItemMessage {
            sequence: 7,
            item: MissionItem { frame, command: 16, parameters, position, autocontinue: true },
            current: 1,
            kind: 1,
            target: Target { system: 3, component: 4 },
            int,
        }
    }

    /// The layout is the dialect's.
    #[test]
    fn it_is_the_message_of_the_dialect() {
        let ours = message(true, 3, [47.397_742_1, -8.545_594_2, 12.25]);
        let theirs = MavMessage::MISSION_ITEM_INT(MISSION_ITEM_INT_DATA {
            param1: 1.5,
            param2: f32::NAN,
            param3: -2.0,
            param4: 0.0,
            x: 473_977_421,
            y: -85_455_942,
            z: 12.25,
            seq: 7,
            command: MavCmd::MAV_CMD_NAV_WAYPOINT,
            target_system: 3,
            target_component: 4,
            frame: MavFrame::MAV_FRAME_GLOBAL_RELATIVE_ALT,
            current: 1,
            autocontinue: 1,
            mission_type: MavMissionType::MAV_MISSION_TYPE_FENCE,
        });
        for version in [Version::One, Version::Two] {
            let frame = |message: &Message| Frame::encode(message, version, 9, (1, 1)).unwrap();
            assert_eq!(frame(&Message::MissionItem(ours)), frame(&theirs.clone().into()), "{version:?}");
        }
    }

    #[test]
    fn places_survive_the_wire_in_every_frame() {
        for (int, frame, position) in [
            (true, 6, [47.397_742_1, -180.0, -0.5]),
            (true, 1, [-12.345_6, 3.0, -10.0]),
            (true, 2, [3.0, -7.0, 45.0]),
            (true, 3, [f64::NAN, f64::NAN, f64::NAN]),
            (false, 0, [47.5, 8.25, 500.0]),
            (false, 77, [f64::NAN, 8.25, 500.0]),
        ] {
            let sent = message(int, frame, position);
            let encoded = Frame::encode(&Message::MissionItem(sent), Version::Two, 1, (1, 1)).unwrap();
            assert_eq!(MissionItemMessage::read(&encoded), Some(sent));
        }
    }
}
