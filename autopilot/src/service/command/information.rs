//! Commands that ask for something.

use vehicle::Refusal;

use crate::autopilot::Autopilot;
use crate::codec::Command;
use crate::service::{Destination, Origin, identification, message_interval, standard_mode, telemetry};

const GET_HOME_POSITION: u16 = 410;
const GET_MESSAGE_INTERVAL: u16 = 510;
const REQUEST_MESSAGE: u16 = 512;
const REQUEST_PROTOCOL_VERSION: u16 = 519;
const REQUEST_AUTOPILOT_CAPABILITIES: u16 = 520;
const HOME_POSITION: u32 = 242;
const AVAILABLE_MODES: u32 = 435;

/// Answers a command that asks for something; `None` if it is none of those.
pub fn handle(autopilot: &mut Autopilot, origin: &Origin, command: &Command) -> Option<Result<(), Refusal>> {
    let to = Destination::Peer(origin.peer);
    Some(match command.number {
        GET_HOME_POSITION => request(autopilot, origin, HOME_POSITION, 0),
        GET_MESSAGE_INTERVAL => match command.whole(1).map(u16::try_from) {
            Some(Ok(message_id)) => {
                message_interval::get(autopilot, origin, message_id);
                Ok(())
            }
            _ => Err(Refusal::denied("a message has a number up to 65535")),
        },
        REQUEST_MESSAGE => match command.whole(1) {
            Some(message_id) => request(autopilot, origin, message_id, command.whole(2).unwrap_or(0)),
            None => Err(Refusal::denied("a message has a number")),
        },
        REQUEST_PROTOCOL_VERSION => {
            autopilot.send(to, identification::protocol_version());
            Ok(())
        }
        REQUEST_AUTOPILOT_CAPABILITIES => {
            let version = identification::autopilot_version(autopilot.identity(), autopilot.system_id());
            autopilot.send(to, version);
            Ok(())
        }
        _ => return None,
    })
}

/// Sends a message once. What there is not is refused without a line for the pilot: clients probe.
fn request(autopilot: &mut Autopilot, origin: &Origin, message_id: u32, which: u32) -> Result<(), Refusal> {
    let messages = if message_id == AVAILABLE_MODES {
        standard_mode::available(autopilot.identity(), which)
    } else {
        telemetry::message(autopilot, message_id).into_iter().collect()
    };
    if messages.is_empty() {
        return Err(Refusal::Unsupported(format!("there is no message {message_id}")));
    }
    for message in messages {
        autopilot.send(Destination::Peer(origin.peer), message);
    }
    Ok(())
}
