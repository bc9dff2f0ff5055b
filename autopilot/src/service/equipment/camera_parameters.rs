//! The settings of the camera by the extended parameter protocol: what CAMERA_SETTINGS shows, under the names that camera definitions
//! use.

use mavlink::dialects::ardupilotmega::{
    MavMessage, MavParamError, MavParamExtType, PARAM_EXT_ACK_DATA, PARAM_EXT_VALUE_DATA, ParamAck,
};
use mavlink::types::CharArray;
use num_traits::FromPrimitive;
use vehicle::equipment::Camera;
use vehicle::{Refusal, Severity};

use super::camera::tell_status;
use super::camera_setting::Setting;
use crate::codec::{Frame, id};
use crate::context::Context;
use crate::envelope::{Destination, Origin};
use crate::service::Service;
use crate::service::parameter::refuse;
use crate::speaker::Speaker;

/// Bytes of a value in a message: those after the first four are zero.
const VALUE_BYTES: usize = 128;

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
                for setting in Setting::ALL {
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
        Ok(index) => Setting::ALL.get(index).copied(),
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

/// The present value of a setting as it travels.
fn value(setting: Setting, camera: &Camera) -> CharArray<VALUE_BYTES> {
    let mut bytes = [0; VALUE_BYTES];
    for (to, from) in bytes.iter_mut().zip(setting.value(camera)) {
        *to = from;
    }
    bytes.into()
}

/// PARAM_EXT_VALUE, to who asked.
fn send_value(context: &mut Context, origin: &Origin, setting: Setting) {
    let index = Setting::ALL.iter().position(|other| *other == setting).unwrap_or_default();
    let message = PARAM_EXT_VALUE_DATA {
        param_count: Setting::ALL.len() as u16,
        param_index: index as u16,
        param_id: setting.name().into(),
        param_value: value(setting, context.vehicle.equipment().camera()),
        param_type: setting.kind(),
    };
    context.outbox.send(Destination::Peer(origin.peer), MavMessage::PARAM_EXT_VALUE(message));
}

/// PARAM_EXT_SET: a change is told to everyone; a refusal, with the present value, to who asked, and why to the pilot.
fn set(context: &mut Context, origin: &Origin, frame: &Frame) {
    let payload = frame.payload();
    let (name, kind) = (payload.name(2), MavParamExtType::from_u8(payload.u8(146)));
    let Some(setting) = Setting::of_name(&name) else {
        let names = Setting::ALL.map(Setting::name).join(", ");
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
        param_value: value(setting, context.vehicle.equipment().camera()),
        param_type: setting.kind(),
        param_result,
    };
    context.outbox.send(to, MavMessage::PARAM_EXT_ACK(ack));
    match result {
        Ok(()) => tell_status(context),
        Err(refusal) => context.say(Severity::Warning, &refusal.to_string()),
    }
}
