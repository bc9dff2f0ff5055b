//! Messages that are sent once, because somebody asks for them.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::{
    AUTOPILOT_VERSION_DATA, AUTOPILOT_VERSION_REQUEST_DATA, FLIGHT_INFORMATION_DATA, HOME_POSITION_DATA,
    MavCmd, PROTOCOL_VERSION_DATA,
};
use vehicle::Refusal;

use super::{CommandEntry, Outcome, Progress, Service};
use crate::codec::{Command, Frame};
use crate::context::Context;
use crate::envelope::{Destination, Origin};
use crate::speaker::Speaker;

const GET_HOME_POSITION: u16 = MavCmd::MAV_CMD_GET_HOME_POSITION as u16;
const REQUEST_PROTOCOL_VERSION: u16 = MavCmd::MAV_CMD_REQUEST_PROTOCOL_VERSION as u16;
const REQUEST_FLIGHT_INFORMATION: u16 = MavCmd::MAV_CMD_REQUEST_FLIGHT_INFORMATION as u16;
const REQUEST_AUTOPILOT_CAPABILITIES: u16 = MavCmd::MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES as u16;

const COMMANDS: &[CommandEntry] = &[
    CommandEntry::question(GET_HOME_POSITION),
    CommandEntry::question(REQUEST_PROTOCOL_VERSION),
    CommandEntry::question(REQUEST_AUTOPILOT_CAPABILITIES),
    CommandEntry::question(REQUEST_FLIGHT_INFORMATION),
];

/// The older commands for one message each; MAV_CMD_REQUEST_MESSAGE belongs to the service of the intervals, which knows one more.
#[derive(Clone, Copy, Debug)]
pub struct MessageRequests;

impl Service for MessageRequests {
    fn summary(&self) -> &'static str {
        "Messages that are asked for once"
    }

    /// ArduPilot's own message from before there were commands for it.
    fn messages(&self) -> &'static [u32] {
        &[AUTOPILOT_VERSION_REQUEST_DATA::ID]
    }

    fn commands(&self) -> &'static [CommandEntry] {
        COMMANDS
    }

    fn speakers(&self) -> &'static [Speaker] {
        &Speaker::ALL
    }

    fn receive(&mut self, context: &mut Context, origin: &Origin, _frame: &Frame) {
        if context.identity().is_ardupilot() {
            // It is always available.
            let _ = send_once(context, origin, Speaker::Autopilot, AUTOPILOT_VERSION_DATA::ID, 0);
        }
    }

    fn command(&mut self, context: &mut Context, origin: &Origin, command: &Command) -> Outcome {
        let id = match command.number {
            GET_HOME_POSITION => HOME_POSITION_DATA::ID,
            REQUEST_FLIGHT_INFORMATION => FLIGHT_INFORMATION_DATA::ID,
            REQUEST_PROTOCOL_VERSION => PROTOCOL_VERSION_DATA::ID,
            _ => AUTOPILOT_VERSION_DATA::ID,
        };
        send_once(context, origin, Speaker::of(command.component).unwrap_or_default(), id, 0)?;
        Ok(Progress::Done)
    }
}

/// Sends a message of the table to who has asked for it; `number` chooses one where there are several. The autopilot answers for camera and
/// gimbal, and each of them for itself.
///
/// # Errors
/// [`Refusal::Unsupported`] for a message that there is not.
pub fn send_once(
    context: &mut Context,
    origin: &Origin,
    asked: Speaker,
    id: u32,
    number: u32,
) -> Result<(), Refusal> {
    let stream = context.streams.get(id);
    let stream = stream.filter(|stream| asked == Speaker::Autopilot || stream.speaker == asked);
    let Some((stream, messages)) = stream
        .map(|stream| (stream, stream.messages(&context.component(), number)))
        .filter(|(_, all)| !all.is_empty())
    else {
        return Err(Refusal::Unsupported(format!("Message {id} is not available")));
    };
    for message in messages {
        context.outbox.send_as(stream.speaker, Destination::Peer(origin.peer), message);
    }
    Ok(())
}
