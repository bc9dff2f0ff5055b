//! A log that is sent while it is written: LOGGING_START, LOGGING_STOP, LOGGING_DATA, LOGGING_DATA_ACKED and LOGGING_ACK, as PX4 has them.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::{
    LOGGING_ACK_DATA, LOGGING_DATA_ACKED_DATA, LOGGING_DATA_DATA, MavCmd, MavMessage,
};
use vehicle::{Refusal, Severity};

use super::{CommandEntry, Outcome, Progress, Service};
use crate::codec::{Command, Frame};
use crate::context::Context;
use crate::envelope::{Destination, Origin, PeerId};
use crate::log_queue::{LogChunk, MOST_BYTES};

const START: u16 = MavCmd::MAV_CMD_LOGGING_START as u16;
const STOP: u16 = MavCmd::MAV_CMD_LOGGING_STOP as u16;
const COMMANDS: &[CommandEntry] = &[CommandEntry::action(START), CommandEntry::action(STOP)];
/// The only format.
const ULOG: f64 = 0.0;
/// PX4's patience: what must arrive is sent each 50 ms of the wall clock, in turns, at most 50 times.
const RETRY_TURNS: usize = 125;
const MOST_TRIES: u32 = 50;
/// No entry of the log begins in a chunk.
const NO_ENTRY: u8 = u8::MAX;

/// Who gets the log, and how far it is.
#[derive(Clone, Copy, Debug)]
struct Receiver {
    peer: PeerId,
    system: u8,
    component: u8,
    sequence: u16,
    /// Times that the next chunk was sent, and turns since the last.
    tries: u32,
    turns: usize,
}

/// Sends the log to one client.
#[derive(Debug, Default)]
pub struct LogStreams {
    receiver: Option<Receiver>,
}

impl Service for LogStreams {
    fn summary(&self) -> &'static str {
        "A flight log that is sent while it is written"
    }

    fn messages(&self) -> &'static [u32] {
        &[LOGGING_ACK_DATA::ID]
    }

    fn commands(&self) -> &'static [CommandEntry] {
        COMMANDS
    }

    fn answers(&self) -> &'static [u32] {
        &[LOGGING_DATA_DATA::ID, LOGGING_DATA_ACKED_DATA::ID]
    }

    fn command(&mut self, context: &mut Context, origin: &Origin, command: &Command) -> Outcome {
        if context.identity().is_ardupilot() {
            let instead = "download its logs (LOG_REQUEST_LIST) instead";
            return Err(Refusal::Unsupported(format!("ArduPilot does not stream logs this way; {instead}")));
        }
        if self.receiver.is_some_and(|receiver| receiver.peer != origin.peer) {
            return Err(Refusal::later("Another client is already receiving the log"));
        }
        if command.number == STOP {
            self.stop(context);
            return Ok(Progress::Done);
        }
        if command.parameter(1) != ULOG {
            let format = command.parameter(1);
            return Err(Refusal::denied(format!("Log format {format} is not supported; use 0 (ULog)")));
        }
        let Origin { peer, system, component, .. } = *origin;
        self.receiver = Some(Receiver { peer, system, component, sequence: 0, tries: 0, turns: 0 });
        context.log_queue.open();
        Ok(Progress::Done)
    }

    fn receive(&mut self, context: &mut Context, origin: &Origin, frame: &Frame) {
        let sequence = frame.payload().u16(0);
        let waits = |receiver: &&mut Receiver| receiver.peer == origin.peer && receiver.tries > 0;
        let Some(receiver) = self.receiver.as_mut().filter(waits) else { return };
        if receiver.sequence == sequence {
            receiver.advance();
            context.log_queue.advance();
        }
    }

    fn is_answering(&self) -> bool {
        self.receiver.is_some()
    }

    fn transfer(&mut self, context: &mut Context, turns: usize, has_room: &dyn Fn(PeerId) -> Option<bool>) {
        let Some(receiver) = &mut self.receiver else { return };
        receiver.turns += turns;
        let mut left = turns;
        loop {
            match has_room(receiver.peer) {
                None => return self.stop(context),
                Some(false) => return,
                Some(true) => {}
            }
            let Some(chunk) = context.log_queue.next() else { return };
            let waits = receiver.tries > 0 && receiver.turns < RETRY_TURNS;
            if left == 0 || waits {
                return;
            }
            if receiver.tries >= MOST_TRIES {
                context.say(Severity::Warning, "Log stream ended: no acknowledgement from the client");
                return self.stop(context);
            }
            left -= 1;
            let (message, must_arrive) = (receiver.message(chunk), chunk.must_arrive);
            context.outbox.send(Destination::Peer(receiver.peer), message);
            if must_arrive {
                receiver.tries += 1;
                receiver.turns = 0;
            } else {
                receiver.advance();
                context.log_queue.advance();
            }
        }
    }
}

impl LogStreams {
    fn stop(&mut self, context: &mut Context) {
        self.receiver = None;
        context.log_queue.close();
    }
}

impl Receiver {
    /// The next chunk is the one behind.
    fn advance(&mut self) {
        self.sequence = self.sequence.wrapping_add(1);
        (self.tries, self.turns) = (0, 0);
    }

    fn message(&self, chunk: &LogChunk) -> MavMessage {
        let Self { system: target_system, component: target_component, sequence, .. } = *self;
        let mut data = [0; MOST_BYTES];
        for (place, byte) in data.iter_mut().zip(&chunk.bytes) {
            *place = *byte;
        }
        let length = chunk.bytes.len().min(MOST_BYTES) as u8;
        let first_message_offset = chunk.first_entry.unwrap_or(NO_ENTRY);
        if chunk.must_arrive {
            MavMessage::LOGGING_DATA_ACKED(LOGGING_DATA_ACKED_DATA {
                sequence,
                target_system,
                target_component,
                length,
                first_message_offset,
                data,
            })
        } else {
            MavMessage::LOGGING_DATA(LOGGING_DATA_DATA {
                sequence,
                target_system,
                target_component,
                length,
                first_message_offset,
                data,
            })
        }
    }
}
