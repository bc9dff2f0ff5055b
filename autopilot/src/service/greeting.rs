//! What this is, for whoever takes it for a flying one: said at the start, and to each peer that is heard for the first
//! time.

use std::collections::VecDeque;

use vehicle::Severity;

use super::{CommandEntry, Outcome, Progress, Service, heartbeat};
use crate::codec::Command;
use crate::context::Context;
use crate::envelope::{Destination, Origin, PeerId};
use crate::status_text;

const INTRODUCTION: &str =
    concat!("lmpc-sitl ", env!("CARGO_PKG_VERSION"), ": simulated quadrotor, Laguerre MPC");
/// Said after that where ArduPilot's conventions hold: clients look for the name of the vehicle whose commands they know.
const ARDUPILOT_CONVENTIONS: &str = "Conventions of ArduCopter V4.6";
/// MAV_CMD_DO_SEND_BANNER, by which ArduPilot's ground stations ask what they are connected to.
const COMMANDS: &[CommandEntry] = &[CommandEntry::question(42_428)];
/// Peers that are remembered as told so.
const MOST_GREETED: usize = 256;

/// Who was told.
#[derive(Clone, Debug, Default)]
pub struct Greeting {
    greeted: VecDeque<PeerId>,
}

impl Service for Greeting {
    fn summary(&self) -> &'static str {
        "Name and version as text"
    }

    fn commands(&self) -> &'static [CommandEntry] {
        COMMANDS
    }

    fn start(&mut self, context: &mut Context) {
        context.say(Severity::Info, INTRODUCTION);
    }

    fn hear(&mut self, context: &mut Context, origin: &Origin) {
        if self.greeted.contains(&origin.peer) {
            return;
        }
        if self.greeted.len() >= MOST_GREETED {
            self.greeted.pop_front();
        }
        self.greeted.push_back(origin.peer);
        context.outbox.send(Destination::Peer(origin.peer), heartbeat::message(&context.vehicle));
        introduce(context, origin);
    }

    fn command(&mut self, context: &mut Context, origin: &Origin, _command: &Command) -> Outcome {
        introduce(context, origin);
        Ok(Progress::Done)
    }
}

fn introduce(context: &mut Context, origin: &Origin) {
    let conventions = Some(ARDUPILOT_CONVENTIONS).filter(|_| context.vehicle.identity().is_ardupilot());
    for text in [INTRODUCTION].into_iter().chain(conventions) {
        for message in status_text::messages(Severity::Info, text, &mut 0) {
            context.outbox.send(Destination::Peer(origin.peer), message);
        }
    }
}
