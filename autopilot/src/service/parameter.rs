//! The parameter protocol.

use mavlink::dialects::common::{MavMessage, MavParamType, PARAM_VALUE_DATA};
use vehicle::Severity;
use vehicle::parameters::Value;

use super::{Destination, Origin};
use crate::autopilot::Autopilot;
use crate::codec::{Encoding, Frame};

/// Name under which clients ask for the hash, and with which QGroundControl says that its cache is right.
const HASH_CHECK: &str = "_HASH_CHECK";
/// Index of what is not in the list.
const NO_INDEX: u16 = u16::MAX;

/// PARAM_REQUEST_LIST: the hash first, so that a client whose cache is right can say so, then everything.
pub fn request_list(autopilot: &mut Autopilot, origin: &Origin) {
    let to = Destination::Peer(origin.peer);
    if !autopilot.identity().is_ardupilot() {
        send_hash(autopilot, to);
    }
    for index in 0..autopilot.table.entries().len() {
        send_value(autopilot, index, to);
    }
}

/// PARAM_REQUEST_READ, by index or by name.
pub fn request_read(autopilot: &mut Autopilot, origin: &Origin, frame: &Frame) {
    let payload = frame.payload();
    let to = Destination::Peer(origin.peer);
    let index = match usize::try_from(payload.i16(0)) {
        Ok(index) => Some(index),
        Err(_) => {
            let name = payload.name(4);
            if name == HASH_CHECK {
                send_hash(autopilot, to);
                return;
            }
            autopilot.table.index_of(&name)
        }
    };
    if let Some(index) = index {
        send_value(autopilot, index, to);
    }
}

/// PARAM_SET: the new value goes to everyone; a refusal is answered with the present one and says why.
pub fn set(autopilot: &mut Autopilot, origin: &Origin, frame: &Frame) {
    let payload = frame.payload();
    let name = payload.name(6);
    if name == HASH_CHECK {
        // "Stop sending": the list is out already.
        return;
    }
    let value = Encoding::of(autopilot.identity()).decode(payload.f32(0), payload.u8(22));
    let result = autopilot.set_parameter(&name, value);
    if let Some(index) = autopilot.table.index_of(&name) {
        let to = if result.is_ok() { Destination::Everyone } else { Destination::Peer(origin.peer) };
        send_value(autopilot, index, to);
    }
    if let Err(error) = result {
        super::status_text::send(autopilot, Severity::Warning, &format!("Parameter refused: {error}"));
    }
}

/// Tells a parameter that something else than PARAM_SET has changed.
pub fn tell(autopilot: &mut Autopilot, id: &str) {
    if let Some(index) = autopilot.table.index_of(id) {
        send_value(autopilot, index, Destination::Everyone);
    }
}

fn send_value(autopilot: &mut Autopilot, index: usize, to: Destination) {
    let Some(value) = autopilot.parameter_value(index) else { return };
    let Some(entry) = autopilot.table.entries().get(index) else { return };
    let message = PARAM_VALUE_DATA {
        param_value: Encoding::of(autopilot.identity()).encode(value),
        param_count: autopilot.table.entries().len() as u16,
        param_index: index as u16,
        param_id: entry.id.as_str().into(),
        param_type: match value {
            Value::Real(_) => MavParamType::MAV_PARAM_TYPE_REAL32,
            Value::Integer(_) => MavParamType::MAV_PARAM_TYPE_INT32,
        },
    };
    autopilot.send(to, MavMessage::PARAM_VALUE(message));
}

fn send_hash(autopilot: &mut Autopilot, to: Destination) {
    let hash = autopilot.parameter_hash();
    let message = PARAM_VALUE_DATA {
        param_value: Encoding::of(autopilot.identity()).encode_hash(hash),
        param_count: autopilot.table.entries().len() as u16,
        param_index: NO_INDEX,
        param_id: HASH_CHECK.into(),
        param_type: MavParamType::MAV_PARAM_TYPE_UINT32,
    };
    autopilot.send(to, MavMessage::PARAM_VALUE(message));
}
