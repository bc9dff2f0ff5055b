//! SERIAL_CONTROL to the shell of an autopilot: there is none, and who types is told so instead of waiting for a prompt.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::{
    MavMessage, SERIAL_CONTROL_DATA, SerialControlDev, SerialControlFlag,
};

use super::Service;
use crate::codec::Frame;
use crate::context::Context;
use crate::envelope::{Destination, Origin};

/// What is answered: it fits into one message.
const ANSWER: &[u8] = b"No shell here: use commands and parameters (book: compatibility)\r\n";

/// Answers for the shell.
#[derive(Clone, Copy, Debug)]
pub struct Shell;

impl Service for Shell {
    fn summary(&self) -> &'static str {
        "Shell: the answer says that there is none"
    }

    fn messages(&self) -> &'static [u32] {
        &[SERIAL_CONTROL_DATA::ID]
    }

    fn answers(&self) -> &'static [u32] {
        &[SERIAL_CONTROL_DATA::ID]
    }

    /// Only what asks for an answer is answered: a console that closes says something, too.
    fn receive(&mut self, context: &mut Context, origin: &Origin, frame: &Frame) {
        let payload = frame.payload();
        let (device, flags, count) = (payload.u8(6), payload.u8(7), payload.u8(8));
        let asks = flags & SerialControlFlag::SERIAL_CONTROL_FLAG_RESPOND.bits() != 0 || count > 0;
        let is_answer = flags & SerialControlFlag::SERIAL_CONTROL_FLAG_REPLY.bits() != 0;
        if device != SerialControlDev::SERIAL_CONTROL_DEV_SHELL as u8 || is_answer || !asks {
            return;
        }
        let mut data = [0; 70];
        for (byte, said) in data.iter_mut().zip(ANSWER) {
            *byte = *said;
        }
        let answer = SERIAL_CONTROL_DATA {
            device: SerialControlDev::SERIAL_CONTROL_DEV_SHELL,
            flags: SerialControlFlag::SERIAL_CONTROL_FLAG_REPLY,
            count: ANSWER.len() as u8,
            data,
            target_system: origin.system,
            target_component: origin.component,
            ..SERIAL_CONTROL_DATA::default()
        };
        context.outbox.send(Destination::Peer(origin.peer), MavMessage::SERIAL_CONTROL(answer));
    }
}
