//! COMMAND_ACK.

use mavlink::dialects::ardupilotmega::MavResult;
use vehicle::Refusal;
use vehicle::identity::Identity;

use crate::codec::{CommandAck, Message};
use crate::envelope::{Destination, Origin};
use crate::outbox::Outbox;
use crate::service::{Outcome, Progress};

/// Answers a command.
pub fn acknowledge(outbox: &mut Outbox, origin: &Origin, command: u16, result: MavResult) {
    send(outbox, origin, command, result, 0);
}

/// Answers a command by what has become of it; `None` if nobody takes it.
pub fn acknowledge_outcome(outbox: &mut Outbox, origin: &Origin, command: u16, outcome: Option<&Outcome>) {
    let progress = match outcome {
        Some(Ok(Progress::Percent(percent))) => *percent,
        _ => 0,
    };
    send(outbox, origin, command, result_of(outcome), progress);
}

/// Refuses a command in place of a component that is not there: clients take an answer from nobody else.
pub fn refuse_in_place_of(outbox: &mut Outbox, component: u8, origin: &Origin, command: u16) {
    let ack = answer(origin, command, MavResult::MAV_RESULT_UNSUPPORTED, 0);
    outbox.send_in_place_of(component, Destination::Peer(origin.peer), Message::CommandAck(ack));
}

/// ArduPilot answers what it cannot do now by a failure.
pub fn as_told_by(identity: Identity, refusal: Refusal) -> Refusal {
    match refusal {
        Refusal::TemporarilyRejected(reason) if identity.is_ardupilot() => Refusal::Failed(reason),
        refusal => refusal,
    }
}

/// MAV_RESULT of what has become of a command; `None` if nobody takes it.
pub fn result_of(outcome: Option<&Outcome>) -> MavResult {
    match outcome {
        Some(Ok(Progress::Done)) => MavResult::MAV_RESULT_ACCEPTED,
        Some(Ok(Progress::Percent(_))) => MavResult::MAV_RESULT_IN_PROGRESS,
        Some(Err(Refusal::TemporarilyRejected(_))) => MavResult::MAV_RESULT_TEMPORARILY_REJECTED,
        Some(Err(Refusal::Denied(_))) => MavResult::MAV_RESULT_DENIED,
        Some(Err(Refusal::Failed(_))) => MavResult::MAV_RESULT_FAILED,
        Some(Err(Refusal::UnsupportedFrame(_))) => MavResult::MAV_RESULT_COMMAND_UNSUPPORTED_MAV_FRAME,
        Some(Err(Refusal::Unsupported(_))) | None => MavResult::MAV_RESULT_UNSUPPORTED,
    }
}

fn send(outbox: &mut Outbox, origin: &Origin, command: u16, result: MavResult, progress: u8) {
    let ack = answer(origin, command, result, progress);
    outbox.send(Destination::Peer(origin.peer), Message::CommandAck(ack));
}

fn answer(origin: &Origin, command: u16, result: MavResult, progress: u8) -> CommandAck {
    CommandAck {
        command,
        result: result as u8,
        progress,
        target_system: origin.system,
        target_component: origin.component,
    }
}
