//! The parameter protocol.

use std::collections::BTreeMap;

use mavlink::dialects::ardupilotmega::{
    MavCmd, MavMessage, MavParamError, MavParamType, MavProtocolCapability, PARAM_ERROR_DATA,
    PARAM_VALUE_DATA,
};
use quadrotor::StabilityWarning;
use vehicle::identity::Identity;
use vehicle::parameters::{SetError, Value};
use vehicle::{Refusal, Severity};

use super::{CommandEntry, Outcome, Progress, Service};
use crate::codec::{Command, Encoding, Frame, id};
use crate::context::Context;
use crate::envelope::{Destination, Origin, PeerId};
use crate::turns::Turns;

/// Name under which clients request the hash, and with which QGroundControl confirms its cache.
const HASH_CHECK: &str = "_HASH_CHECK";
/// PX4 tells a changed parameter once more, after this time, µs: MAVSDK takes the first one for the answer to its request, and only
/// the second one for news.
const AGAIN_US: u64 = 500_000;
/// Index of what is not in the list.
const NO_INDEX: u16 = u16::MAX;
/// Index in PARAM_ERROR of what was asked for by its name.
const BY_NAME: i16 = -1;

const COMMANDS: &[CommandEntry] = &[CommandEntry::action(MavCmd::MAV_CMD_PREFLIGHT_STORAGE as u16)];

/// What a peer gets next of a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Next {
    /// The hash over all parameters.
    Hash,
    /// A parameter.
    Index(usize),
}

/// Lists, reads and changes parameters.
#[derive(Clone, Debug, Default)]
pub struct ParameterProtocol {
    /// Lists that are being sent, one for each peer.
    lists: BTreeMap<PeerId, Next>,
    turns: Turns,
    /// Parameters that have been changed and are told once more, by index, and when, µs.
    changed: BTreeMap<usize, u64>,
}

impl Service for ParameterProtocol {
    fn summary(&self) -> &'static str {
        "Parameters"
    }

    fn answers(&self) -> &'static [u32] {
        &[id::PARAM_VALUE, id::PARAM_ERROR]
    }

    fn messages(&self) -> &'static [u32] {
        &[id::PARAM_REQUEST_READ, id::PARAM_REQUEST_LIST, id::PARAM_SET]
    }

    fn commands(&self) -> &'static [CommandEntry] {
        COMMANDS
    }

    fn capabilities(&self, identity: Identity) -> MavProtocolCapability {
        let encoding = if identity.is_ardupilot() {
            MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_C_CAST
        } else {
            MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_BYTEWISE
        };
        MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_PARAM_FLOAT | encoding
    }

    fn receive(&mut self, context: &mut Context, origin: &Origin, frame: &Frame) {
        match frame.message_id() {
            id::PARAM_REQUEST_READ => request_read(context, origin, frame),
            id::PARAM_REQUEST_LIST => self.request_list(context, origin),
            _ => self.set(context, origin, frame),
        }
    }

    fn tick(&mut self, context: &mut Context) {
        let now_us = context.vehicle.time_us();
        while let Some((&index, _)) = self.changed.iter().find(|(_, at_us)| **at_us <= now_us) {
            self.changed.remove(&index);
            send_value(context, index, Destination::Everyone);
        }
    }

    fn command(&mut self, context: &mut Context, _origin: &Origin, command: &Command) -> Outcome {
        storage(context, command).map(|()| Progress::Done)
    }

    fn is_answering(&self) -> bool {
        !self.lists.is_empty()
    }

    fn transfer(&mut self, context: &mut Context, turns: usize, has_room: &dyn Fn(PeerId) -> Option<bool>) {
        self.lists.retain(|peer, _| has_room(*peer).is_some());
        for _ in 0..turns {
            let ready = self.lists.keys().copied().filter(|peer| has_room(*peer) == Some(true));
            let Some(peer) = self.turns.next(ready) else { return };
            self.send_next(context, peer);
        }
    }
}

impl ParameterProtocol {
    /// PARAM_REQUEST_LIST: the hash first, so that a client with a valid cache can stop, then everything. A second request of a peer
    /// begins again.
    fn request_list(&mut self, context: &Context, origin: &Origin) {
        let next = if context.identity().is_ardupilot() { Next::Index(0) } else { Next::Hash };
        self.lists.insert(origin.peer, next);
    }

    /// Sends the next message of a list.
    fn send_next(&mut self, context: &mut Context, peer: PeerId) {
        let Some(next) = self.lists.get_mut(&peer) else { return };
        let to = Destination::Peer(peer);
        let following = match *next {
            Next::Hash => {
                send_hash(context, to);
                0
            }
            Next::Index(index) => {
                send_value(context, index, to);
                index + 1
            }
        };
        *next = Next::Index(following);
        if following >= context.parameters.table().entries().len() {
            self.lists.remove(&peer);
        }
    }

    /// PARAM_SET. The client with a valid cache sets the hash: it needs no more of the list.
    fn set(&mut self, context: &mut Context, origin: &Origin, frame: &Frame) {
        if frame.payload().name(6) == HASH_CHECK {
            self.lists.remove(&origin.peer);
        } else if let Some(index) = set(context, origin, frame)
            && !context.identity().is_ardupilot()
        {
            self.changed.insert(index, context.vehicle.time_us() + AGAIN_US);
        }
    }
}

/// PARAM_REQUEST_READ, by index or by name.
fn request_read(context: &mut Context, origin: &Origin, frame: &Frame) {
    let payload = frame.payload();
    let to = Destination::Peer(origin.peer);
    if let Ok(index) = usize::try_from(payload.i16(0)) {
        if context.parameters.table().entries().len() > index {
            send_value(context, index, to);
        } else {
            refuse(context, origin, payload.i16(0), "", MavParamError::MAV_PARAM_ERROR_DOES_NOT_EXIST);
        }
        return;
    }
    let name = payload.name(4);
    if name == HASH_CHECK {
        send_hash(context, to);
    } else if let Some(index) = context.parameters.table().index_of(&name) {
        send_value_as(context, index, &name, to);
    } else {
        refuse(context, origin, payload.i16(0), &name, MavParamError::MAV_PARAM_ERROR_DOES_NOT_EXIST);
    }
}

/// PARAM_ERROR: why a request could not be met, to who made it.
pub fn refuse(context: &mut Context, origin: &Origin, param_index: i16, name: &str, error: MavParamError) {
    let message = PARAM_ERROR_DATA {
        param_index,
        target_system: origin.system,
        target_component: origin.component,
        param_id: name.into(),
        error,
    };
    context.outbox.send(Destination::Peer(origin.peer), MavMessage::PARAM_ERROR(message));
}

/// MAV_PARAM_ERROR of a refused change.
fn error_code(error: &SetError) -> MavParamError {
    match error {
        SetError::Unknown { .. } => MavParamError::MAV_PARAM_ERROR_DOES_NOT_EXIST,
        SetError::NotAllowed { .. } => MavParamError::MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE,
        SetError::ReadOnly(_) | SetError::Calculated(_) | SetError::Counted(_) => {
            MavParamError::MAV_PARAM_ERROR_READ_ONLY
        }
        // The closed loop could not fly with it, or nothing here could follow it now.
        SetError::Refused { .. } => MavParamError::MAV_PARAM_ERROR_PERMISSION_DENIED,
    }
}

/// What is wrong with PARAM_SET.
enum Mistake {
    /// Its type.
    Type,
    /// Its name or value.
    Value(SetError),
}

impl Mistake {
    fn code(&self) -> MavParamError {
        match self {
            Self::Type => MavParamError::MAV_PARAM_ERROR_TYPE_MISMATCH,
            Self::Value(error) => error_code(error),
        }
    }

    fn words(&self, name: &str) -> String {
        match self {
            Self::Type => format!("{name} is a real number: set it as REAL32"),
            Self::Value(error) => error.to_string(),
        }
    }
}

/// Changes a parameter at an index of the table, if there is one, as PARAM_SET asks.
fn change(
    context: &mut Context,
    index: Option<usize>,
    name: &str,
    field: f32,
    kind: u8,
) -> Result<(), Mistake> {
    let encoding = Encoding::of(context.identity());
    let present = index.and_then(|index| context.parameters.value(index, &context.vehicle));
    if present.is_some_and(|present| !encoding.fits(present, kind)) {
        return Err(Mistake::Type);
    }
    let value = encoding.decode(field, kind);
    context.parameters.set(name, value, &mut context.vehicle).map_err(Mistake::Value)
}

/// PARAM_SET: the new value goes to everyone. A refusal says why, then what the value still is: MAVSDK takes the first answer for that to
/// its request, and sends the request again when that is a value that it did not ask for. Returns what was changed.
fn set(context: &mut Context, origin: &Origin, frame: &Frame) -> Option<usize> {
    let payload = frame.payload();
    let name = payload.name(6);
    let known = stability_warnings(context);
    let index = context.parameters.table().index_of(&name);
    let result = change(context, index, &name, payload.f32(0), payload.u8(22));
    let changed = index.filter(|_| result.is_ok());
    if let Err(mistake) = &result {
        refuse(context, origin, BY_NAME, &name, mistake.code());
    }
    if let Some(index) = index {
        let listed = context.parameters.table().entries().get(index).is_some_and(|entry| entry.id == name);
        if result.is_ok() {
            send_value(context, index, Destination::Everyone);
        }
        if result.is_err() || !listed {
            send_value_as(context, index, &name, Destination::Peer(origin.peer));
        }
    }
    if let Err(mistake) = result {
        context.say(Severity::Warning, &mistake.words(&name));
    }
    for warning in stability_warnings(context) {
        if !known.contains(&warning) {
            context.say(Severity::Warning, &format!("{name}: {warning}"));
        }
    }
    changed
}

/// What is worth a warning about the vehicle's closed loop.
fn stability_warnings(context: &Context) -> Vec<StabilityWarning> {
    context.vehicle.stability_warnings().to_vec()
}

/// Sends a parameter that something else than PARAM_SET has changed.
pub fn tell(context: &mut Context, id: &str) {
    if let Some(index) = context.parameters.table().index_of(id) {
        send_value(context, index, Destination::Everyone);
    }
}

fn send_value(context: &mut Context, index: usize, to: Destination) {
    let Some(entry) = context.parameters.table().entries().get(index) else { return };
    send_value_as(context, index, entry.id, to);
}

/// Sends a parameter under the name that a client knows: it takes no other for the answer to its request.
fn send_value_as(context: &mut Context, index: usize, name: &str, to: Destination) {
    let Some(value) = context.parameters.value(index, &context.vehicle) else { return };
    let message = PARAM_VALUE_DATA {
        param_value: Encoding::of(context.identity()).encode(value),
        param_count: context.parameters.table().entries().len() as u16,
        param_index: index as u16,
        param_id: name.into(),
        param_type: match value {
            Value::Real(_) => MavParamType::MAV_PARAM_TYPE_REAL32,
            Value::Integer(_) => MavParamType::MAV_PARAM_TYPE_INT32,
        },
    };
    context.outbox.send(to, MavMessage::PARAM_VALUE(message));
}

fn send_hash(context: &mut Context, to: Destination) {
    let hash = context.parameters.hash(&context.vehicle);
    let message = PARAM_VALUE_DATA {
        param_value: Encoding::of(context.identity()).encode_hash(hash),
        param_count: context.parameters.table().entries().len() as u16,
        param_index: NO_INDEX,
        param_id: HASH_CHECK.into(),
        param_type: MavParamType::MAV_PARAM_TYPE_UINT32,
    };
    context.outbox.send(to, MavMessage::PARAM_VALUE(message));
}

/// 0 reads, 1 writes, 2 resets the parameters.
fn storage(context: &mut Context, command: &Command) -> Result<(), Refusal> {
    if context.vehicle.is_armed() && !context.identity().is_ardupilot() {
        return Err(Refusal::later("Parameter storage rejected: disarm first"));
    }
    match command.parameter(1) {
        // They are read at the start, and always written when one changes.
        0.0 | 1.0 => Ok(()),
        2.0 => context.parameters.reset(&mut context.vehicle),
        other => Err(Refusal::denied(format!(
            "Parameter storage denied: action {other}; allowed 0 (read), 1 (write), 2 (reset)"
        ))),
    }
}
