//! The command protocol: COMMAND_LONG and COMMAND_INT, and the older SET_MODE. Every command is answered.

mod action;
pub mod calibration;
mod information;
mod retry;

pub use retry::Retries;

use vehicle::plan::{frame, is_global};
use vehicle::{Refusal, Severity};

use super::{Destination, Origin};
use crate::autopilot::Autopilot;
use crate::codec::{Command, CommandAck, CommandKind, Frame, Message};

/// MAV_RESULT.
mod result {
    pub const ACCEPTED: u8 = 0;
    pub const TEMPORARILY_REJECTED: u8 = 1;
    pub const DENIED: u8 = 2;
    pub const UNSUPPORTED: u8 = 3;
    pub const FAILED: u8 = 4;
    pub const IN_PROGRESS: u8 = 5;
    pub const CANCELLED: u8 = 6;
    pub const UNSUPPORTED_MAV_FRAME: u8 = 9;
}

/// What becomes of a command: carried out, refused with a reason, or unknown (`None`).
type Outcome = Option<Result<(), Refusal>>;

/// Carries a command out, or repeats its answer if it has been carried out already. The answer goes before everything
/// that the command makes the vehicle send.
pub fn handle(autopilot: &mut Autopilot, origin: &Origin, frame: &Frame) {
    let Some(command) = Command::read(frame) else { return };
    // Asking again for information must bring it again: its first answer may be what was lost.
    let mark = autopilot.mark();
    if let Some(outcome) = information::handle(autopilot, origin, &command) {
        let code = code(&Some(outcome));
        acknowledge(autopilot, origin, command.number, code);
        autopilot.last_to(mark);
        return;
    }
    if command.number == calibration::NUMBER {
        calibration::handle(autopilot, origin, &command);
        return;
    }
    let time_us = autopilot.vehicle.time_us();
    if let Some(code) = autopilot.retries.answer(origin, &command, frame.sequence(), time_us) {
        acknowledge(autopilot, origin, command.number, code);
        return;
    }
    let outcome = action::handle(autopilot, origin, &command);
    let code = code(&outcome);
    autopilot.retries.remember(origin, &command, frame.sequence(), time_us, code);
    acknowledge(autopilot, origin, command.number, code);
    autopilot.last_to(mark);
    explain(autopilot, &outcome);
}

/// Says why a command was refused.
fn explain(autopilot: &mut Autopilot, outcome: &Outcome) {
    if let Some(Err(refusal)) = outcome {
        super::status_text::send(autopilot, Severity::Warning, &refusal.to_string());
    }
}

/// SET_MODE: answered as the command that replaced it, as PX4 and ArduPilot do.
pub fn set_mode(autopilot: &mut Autopilot, origin: &Origin, frame: &Frame) {
    let payload = frame.payload();
    let custom_mode = payload.u32(0);
    let outcome = Some(action::set_custom_mode(autopilot, custom_mode));
    const SET_MODE_MESSAGE: u16 = 11;
    acknowledge(autopilot, origin, SET_MODE_MESSAGE, code(&outcome));
    explain(autopilot, &outcome);
}

fn code(outcome: &Outcome) -> u8 {
    match outcome {
        Some(Ok(())) => result::ACCEPTED,
        Some(Err(Refusal::TemporarilyRejected(_))) => result::TEMPORARILY_REJECTED,
        Some(Err(Refusal::Denied(_))) => result::DENIED,
        Some(Err(Refusal::Failed(_))) => result::FAILED,
        Some(Err(Refusal::UnsupportedFrame(_))) => result::UNSUPPORTED_MAV_FRAME,
        Some(Err(Refusal::Unsupported(_))) | None => result::UNSUPPORTED,
    }
}

fn acknowledge(autopilot: &mut Autopilot, origin: &Origin, command: u16, result: u8) {
    send(autopilot, origin, command, result, 0);
}

/// How far a command is that takes time, percent.
fn acknowledge_progress(autopilot: &mut Autopilot, origin: &Origin, command: u16, percent: u8) {
    send(autopilot, origin, command, result::IN_PROGRESS, percent);
}

fn send(autopilot: &mut Autopilot, origin: &Origin, command: u16, result: u8, progress: u8) {
    let ack = CommandAck {
        command,
        result,
        progress,
        target_system: origin.system,
        target_component: origin.component,
    };
    autopilot.send(Destination::Peer(origin.peer), Message::CommandAck(ack));
}

/// The frame in which a command's place is meant: COMMAND_LONG has none and means latitude, longitude and sea level.
fn told_frame(command: &Command) -> u8 {
    match command.kind {
        CommandKind::Long { .. } => frame::GLOBAL,
        CommandKind::Int { frame } => frame,
    }
}

/// The same, if it is one of latitude and longitude.
fn global_frame(command: &Command) -> Result<u8, Refusal> {
    match told_frame(command) {
        frame if is_global(frame) => Ok(frame),
        frame => Err(Refusal::UnsupportedFrame(format!(
            "Frame {frame} is not supported: a place has a global one"
        ))),
    }
}
