//! The settings of the camera by the extended parameter protocol: what CAMERA_SETTINGS shows, under the names that camera definitions
//! use.

use mavlink::dialects::ardupilotmega::{
    MavMessage, MavParamError, MavParamExtType, PARAM_EXT_ACK_DATA, PARAM_EXT_VALUE_DATA, ParamAck,
};
use mavlink::types::CharArray;
use num_traits::FromPrimitive;
use vehicle::equipment::{Camera, CameraMode, Drive, Operation};
use vehicle::{Refusal, Severity};

use super::camera::tell_status;
use super::camera_messages::mode_id;
use crate::codec::{Frame, id};
use crate::context::Context;
use crate::envelope::{Destination, Origin};
use crate::service::Service;
use crate::service::parameter::refuse;
use crate::speaker::Speaker;

/// Bytes of a value in a message: those after the first four are zero.
const VALUE_BYTES: usize = 128;

/// What can be set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Setting {
    Mode,
    Zoom,
    Focus,
}

/// All of them, in the order of the list.
const SETTINGS: [Setting; 3] = [Setting::Mode, Setting::Zoom, Setting::Focus];

impl Setting {
    fn of_name(name: &str) -> Option<Self> {
        SETTINGS.into_iter().find(|setting| setting.name() == name)
    }

    fn name(self) -> &'static str {
        match self {
            Self::Mode => "CAM_MODE",
            Self::Zoom => "CAM_ZOOM",
            Self::Focus => "CAM_FOCUS",
        }
    }

    /// INT32 in place of the UINT32 of most camera definitions: MAVSDK's parameter plugin reads and sets no other whole numbers.
    fn kind(self) -> MavParamExtType {
        match self {
            Self::Mode => MavParamExtType::MAV_PARAM_EXT_TYPE_INT32,
            Self::Zoom | Self::Focus => MavParamExtType::MAV_PARAM_EXT_TYPE_REAL32,
        }
    }

    /// What its values may be, with the type.
    fn allowed(self) -> &'static str {
        match self {
            Self::Mode => "0 (image), 1 (video), 2 (survey) as INT32",
            Self::Zoom | Self::Focus => "0 to 100 (percent) as REAL32",
        }
    }

    /// Its present value as it travels.
    fn value(self, camera: &Camera) -> CharArray<VALUE_BYTES> {
        let bytes = match self {
            Self::Mode => (mode_id(camera) as i32).to_le_bytes(),
            Self::Zoom => (camera.zoom_percent() as f32).to_le_bytes(),
            Self::Focus => (camera.focus_percent() as f32).to_le_bytes(),
        };
        let mut value = [0; VALUE_BYTES];
        for (to, from) in value.iter_mut().zip(bytes) {
            *to = from;
        }
        value.into()
    }

    /// What a value asks of the camera; `None`: it has no such value.
    fn operation(self, bytes: [u8; 4]) -> Option<Operation> {
        let percent = f64::from(f32::from_le_bytes(bytes));
        let drive = (0.0..=100.0).contains(&percent).then_some(Drive::Range(percent));
        match self {
            Self::Mode => {
                let modes = [CameraMode::Image, CameraMode::Video, CameraMode::Survey];
                let index = usize::try_from(i32::from_le_bytes(bytes)).ok()?;
                modes.get(index).copied().map(Operation::SetCameraMode)
            }
            Self::Zoom => drive.map(Operation::Zoom),
            Self::Focus => drive.map(Operation::Focus),
        }
    }
}

/// Lists, reads and changes the settings of the camera.
#[derive(Clone, Copy, Debug)]
pub struct CameraParameters;

impl Service for CameraParameters {
    fn summary(&self) -> &'static str {
        "Settings of the camera"
    }

    fn messages(&self) -> &'static [u32] {
        &[id::PARAM_EXT_REQUEST_READ, id::PARAM_EXT_REQUEST_LIST, id::PARAM_EXT_SET]
    }

    fn answers(&self) -> &'static [u32] {
        &[id::PARAM_EXT_VALUE, id::PARAM_EXT_ACK]
    }

    /// The autopilot answers for the camera, too: clients take it for the camera where it speaks for it.
    fn speakers(&self) -> &'static [Speaker] {
        &[Speaker::Autopilot, Speaker::Camera]
    }

    fn receive(&mut self, context: &mut Context, origin: &Origin, frame: &Frame) {
        match frame.message_id() {
            id::PARAM_EXT_REQUEST_READ => read(context, origin, frame),
            id::PARAM_EXT_REQUEST_LIST => {
                for setting in SETTINGS {
                    send_value(context, origin, setting);
                }
            }
            _ => set(context, origin, frame),
        }
    }
}

/// PARAM_EXT_REQUEST_READ, by index or by name. The protocol has no refusal of its own for what there is not.
fn read(context: &mut Context, origin: &Origin, frame: &Frame) {
    let payload = frame.payload();
    let (index, name) = (payload.i16(0), payload.name(4));
    let found = match usize::try_from(index) {
        Ok(index) => SETTINGS.get(index).copied(),
        Err(_) => Setting::of_name(&name),
    };
    match found {
        Some(setting) => send_value(context, origin, setting),
        None => {
            let name = if index < 0 { &name } else { "" };
            refuse(context, origin, index, name, MavParamError::MAV_PARAM_ERROR_DOES_NOT_EXIST);
        }
    }
}

/// PARAM_EXT_VALUE, to who asked.
fn send_value(context: &mut Context, origin: &Origin, setting: Setting) {
    let index = SETTINGS.iter().position(|other| *other == setting).unwrap_or_default();
    let message = PARAM_EXT_VALUE_DATA {
        param_count: SETTINGS.len() as u16,
        param_index: index as u16,
        param_id: setting.name().into(),
        param_value: setting.value(context.vehicle.equipment().camera()),
        param_type: setting.kind(),
    };
    context.outbox.send(Destination::Peer(origin.peer), MavMessage::PARAM_EXT_VALUE(message));
}

/// PARAM_EXT_SET: a change is told to everyone; a refusal, with the present value, to who asked, and why to the pilot.
fn set(context: &mut Context, origin: &Origin, frame: &Frame) {
    let payload = frame.payload();
    let (name, kind) = (payload.name(2), MavParamExtType::from_u8(payload.u8(146)));
    let Some(setting) = Setting::of_name(&name) else {
        let names = SETTINGS.map(Setting::name).join(", ");
        context.say(Severity::Warning, &format!("The camera has no setting {name}; it has {names}"));
        let ack = PARAM_EXT_ACK_DATA {
            param_id: name.as_str().into(),
            param_value: payload.bytes::<VALUE_BYTES>(18).into(),
            param_type: kind.unwrap_or_default(),
            param_result: ParamAck::PARAM_ACK_FAILED,
        };
        context.outbox.send(Destination::Peer(origin.peer), MavMessage::PARAM_EXT_ACK(ack));
        return;
    };
    let operation = setting.operation(payload.bytes(18)).filter(|_| kind == Some(setting.kind()));
    let result = operation
        .ok_or_else(|| Refusal::denied(format!("{name} rejected: allowed {}", setting.allowed())))
        .and_then(|operation| context.vehicle.operate(&operation));
    let (param_result, to) = match &result {
        Ok(()) => (ParamAck::PARAM_ACK_ACCEPTED, Destination::Everyone),
        Err(Refusal::Denied(_)) => (ParamAck::PARAM_ACK_VALUE_UNSUPPORTED, Destination::Peer(origin.peer)),
        Err(_) => (ParamAck::PARAM_ACK_FAILED, Destination::Peer(origin.peer)),
    };
    let ack = PARAM_EXT_ACK_DATA {
        param_id: setting.name().into(),
        param_value: setting.value(context.vehicle.equipment().camera()),
        param_type: setting.kind(),
        param_result,
    };
    context.outbox.send(to, MavMessage::PARAM_EXT_ACK(ack));
    match result {
        Ok(()) => tell_status(context),
        Err(refusal) => context.say(Severity::Warning, &refusal.to_string()),
    }
}
