//! The settings of the camera by the extended parameter protocol, as MAVLink specifies it.

use autopilot::Autopilot;
use autopilot::codec::{Frame, Message, Version, command_long};
use autopilot::envelope::{Destination, LinkProfile, Origin, PeerId};
use mavlink::dialects::ardupilotmega::*;
use vehicle::VehicleSettings;
use vehicle::identity::Identity;
use vehicle::parameters::Speed;

use MavParamExtType::{MAV_PARAM_EXT_TYPE_INT32 as INT32, MAV_PARAM_EXT_TYPE_REAL32 as REAL32};
use ParamAck::{
    PARAM_ACK_ACCEPTED as ACCEPTED, PARAM_ACK_FAILED as FAILED, PARAM_ACK_VALUE_UNSUPPORTED as UNSUPPORTED,
};

const CAMERA: u8 = 100;
const ORIGIN: Origin = Origin { peer: PeerId { link: 0, number: 1 }, system: 255, component: 190 };

struct Bench {
    autopilot: Autopilot,
    sequence: u8,
}

impl Bench {
    fn new() -> Self {
        let settings = VehicleSettings::new(Identity::Px4);
        let autopilot = Autopilot::new(&settings, 1, Speed::Factor(1.0), &[LinkProfile::Ground], 0);
        let mut bench = Self { autopilot: autopilot.expect("valid settings"), sequence: 0 };
        // Who is new is greeted.
        bench.ask(MavMessage::PARAM_EXT_REQUEST_LIST(PARAM_EXT_REQUEST_LIST_DATA {
            target_system: 1,
            target_component: CAMERA,
        }));
        bench
    }

    /// Sends a message; what is answered to it, to whom and from which component.
    fn ask(&mut self, message: MavMessage) -> Vec<(MavMessage, Destination, u8)> {
        self.sequence = self.sequence.wrapping_add(1);
        let frame = Frame::encode(&message.into(), Version::Two, self.sequence, (255, 190)).expect("a frame");
        drop(self.autopilot.take_outgoing());
        self.autopilot.receive(&ORIGIN, &frame);
        let typed = self.autopilot.take_outgoing().filter_map(|outgoing| match outgoing.message {
            Message::Typed(message) => Some((message, outgoing.to, outgoing.component)),
            _ => None,
        });
        typed.collect()
    }

    fn values(&mut self, message: MavMessage) -> Vec<(String, u16, u16, MavParamExtType, [u8; 4], u8)> {
        let value = |(message, to, component)| match message {
            MavMessage::PARAM_EXT_VALUE(value) => {
                assert_eq!(to, Destination::Peer(ORIGIN.peer));
                let name = value.param_id.to_str().expect("a name").to_owned();
                let bytes = bytes_of(&value.param_value);
                Some((name, value.param_index, value.param_count, value.param_type, bytes, component))
            }
            _ => None,
        };
        self.ask(message).into_iter().filter_map(value).collect()
    }

    fn value_of(&mut self, name: &str) -> [u8; 4] {
        let [(_, _, _, _, bytes, _)] = self.values(read(name, -1))[..] else { panic!("{name}") };
        bytes
    }

    /// Sets a value: result, value and recipient of the answer, and CAMERA_SETTINGS that went to all.
    fn set(&mut self, name: &str, kind: MavParamExtType, bytes: [u8; 4]) -> Set {
        let mut param_value = [0; 128];
        param_value[..4].copy_from_slice(&bytes);
        let messages = self.ask(MavMessage::PARAM_EXT_SET(PARAM_EXT_SET_DATA {
            target_system: 1,
            target_component: CAMERA,
            param_id: name.into(),
            param_value: param_value.into(),
            param_type: kind,
        }));
        let answer = messages.iter().find_map(|(message, to, component)| match message {
            MavMessage::PARAM_EXT_ACK(ack) => {
                assert_eq!((ack.param_id.to_str(), *component), (Ok(name), CAMERA));
                Some((ack.param_result, bytes_of(&ack.param_value), *to))
            }
            _ => None,
        });
        let (result, value, to) = answer.expect("every change is answered");
        let settings = messages.into_iter().find_map(|(message, ..)| match message {
            MavMessage::CAMERA_SETTINGS(settings) => {
                Some((settings.mode_id as u32, settings.zoomLevel, settings.focusLevel))
            }
            _ => None,
        });
        Set { result, value, to, settings }
    }
}

#[derive(Debug, PartialEq)]
struct Set {
    result: ParamAck,
    value: [u8; 4],
    to: Destination,
    settings: Option<(u32, f32, f32)>,
}

/// The first four bytes of a value; the others are zero.
fn bytes_of(value: &[u8; 128]) -> [u8; 4] {
    assert!(value[4..].iter().all(|byte| *byte == 0));
    [value[0], value[1], value[2], value[3]]
}

fn read(name: &str, param_index: i16) -> MavMessage {
    MavMessage::PARAM_EXT_REQUEST_READ(PARAM_EXT_REQUEST_READ_DATA {
        param_index,
        target_system: 1,
        target_component: CAMERA,
        param_id: name.into(),
    })
}

fn list(target_component: u8) -> MavMessage {
    MavMessage::PARAM_EXT_REQUEST_LIST(PARAM_EXT_REQUEST_LIST_DATA { target_system: 1, target_component })
}

#[test]
fn the_list_is_answered_at_once_by_who_was_asked() {
    let mut bench = Bench::new();
    for (asked, speaker) in [(CAMERA, CAMERA), (1, 1), (0, 1)] {
        let row = |name: &str, index, kind| (name.to_owned(), index, 3, kind, [0; 4], speaker);
        let expected = [row("CAM_MODE", 0, INT32), row("CAM_ZOOM", 1, REAL32), row("CAM_FOCUS", 2, REAL32)];
        assert_eq!(bench.values(list(asked)), expected);
    }
    assert_eq!(bench.values(list(154)), [], "the gimbal has none");
}

#[test]
fn one_is_read_by_its_name_or_its_index_and_what_there_is_not_is_refused() {
    let mut bench = Bench::new();
    let by_name = bench.values(read("CAM_FOCUS", -1));
    assert_eq!((by_name.len(), by_name[0].1), (1, 2));
    assert_eq!(bench.values(read("", 2)), by_name);
    assert_eq!(bench.values(read("CAM_MODE", 2)), by_name, "the index counts");
    for (name, index) in [("NO_SUCH_NAME", -1), ("", 3)] {
        let answers = bench.ask(read(name, index));
        let told = answers.iter().any(|(message, ..)| match message {
            MavMessage::PARAM_ERROR(error) => {
                (error.param_id.to_str(), error.param_index, error.error)
                    == (Ok(name), index, MavParamError::MAV_PARAM_ERROR_DOES_NOT_EXIST)
            }
            _ => false,
        });
        assert!(told, "{answers:?}");
    }
}

#[test]
fn a_change_moves_the_camera_and_is_told_to_all() {
    let mut bench = Bench::new();
    let accepted = |value, settings| Set {
        result: ACCEPTED,
        value,
        to: Destination::Everyone,
        settings: Some(settings),
    };
    let (survey, zoom, focus) = (2i32.to_le_bytes(), 30.5f32.to_le_bytes(), 100f32.to_le_bytes());
    assert_eq!(bench.set("CAM_MODE", INT32, survey), accepted(survey, (2, 0.0, 0.0)));
    assert_eq!(bench.set("CAM_ZOOM", REAL32, zoom), accepted(zoom, (2, 30.5, 0.0)));
    assert_eq!(bench.set("CAM_FOCUS", REAL32, focus), accepted(focus, (2, 30.5, 100.0)));
    assert_eq!(["CAM_MODE", "CAM_ZOOM", "CAM_FOCUS"].map(|name| bench.value_of(name)), [survey, zoom, focus]);
    // What a command changes is read here, too.
    let range = [2.0, 75.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    bench.ask(MavMessage::COMMAND_LONG(command_long((1, CAMERA), MavCmd::MAV_CMD_SET_CAMERA_ZOOM, range)));
    assert_eq!(bench.value_of("CAM_ZOOM"), 75f32.to_le_bytes());
}

#[test]
fn what_the_camera_cannot_be_set_to_is_refused_with_the_present_value() {
    let mut bench = Bench::new();
    let zoom = 40f32.to_le_bytes();
    assert_eq!(bench.set("CAM_ZOOM", REAL32, zoom).result, ACCEPTED);
    let refused = |result, value| Set { result, value, to: Destination::Peer(ORIGIN.peer), settings: None };
    for percent in [-0.5, 100.5, f32::NAN, f32::INFINITY] {
        assert_eq!(bench.set("CAM_ZOOM", REAL32, percent.to_le_bytes()), refused(UNSUPPORTED, zoom));
    }
    assert_eq!(bench.set("CAM_ZOOM", INT32, 50i32.to_le_bytes()), refused(UNSUPPORTED, zoom), "wrong type");
    assert_eq!(bench.set("CAM_MODE", INT32, 3i32.to_le_bytes()), refused(UNSUPPORTED, [0; 4]));
    assert_eq!(bench.set("CAM_MODE", INT32, (-1i32).to_le_bytes()), refused(UNSUPPORTED, [0; 4]));
    assert_eq!(bench.set("CAM_ISO", INT32, [7; 4]), refused(FAILED, [7; 4]), "no such setting");
    assert_eq!(bench.value_of("CAM_ZOOM"), zoom);
}
