//! What a ground station sends, for tests of a fleet without sockets.

use autopilot::codec::{Frame, Version, command_long};
use autopilot::envelope::{Origin, PeerId};
use mavlink::dialects::ardupilotmega::{MavCmd, MavMessage};

use crate::link::Received;

const STATION: Origin = Origin { peer: PeerId { link: 0, number: 1 }, system: 255, component: 190 };

/// A message as it is received.
pub fn received(message: MavMessage) -> Received {
    let frame = Frame::encode(&message.into(), Version::Two, 0, (STATION.system, STATION.component));
    Received { origin: STATION, frame: frame.expect("MAVLink 2") }
}

/// A command to the first vehicle, with its first and its last parameter.
pub fn command(command: MavCmd, param1: f32, param7: f32) -> Received {
    let parameters = [param1, 0.0, 0.0, 0.0, 0.0, 0.0, param7];
    received(MavMessage::COMMAND_LONG(command_long((1, 1), command, parameters)))
}
