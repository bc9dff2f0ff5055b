//! What this is, for whoever takes it for a flying one: said at the start, and to each peer that is heard for the first
//! time.

use std::collections::VecDeque;

use vehicle::Severity;

use super::{Service, heartbeat};
use crate::context::Context;
use crate::envelope::{Destination, Origin, PeerId};
use crate::status_text;

const INTRODUCTION: &str =
    concat!("lmpc-sitl ", env!("CARGO_PKG_VERSION"), ": simulated quadrotor, Laguerre MPC");
/// Peers that are remembered as told so.
const MOST_GREETED: usize = 256;

/// Who was told.
#[derive(Clone, Debug, Default)]
pub struct Greeting {
    greeted: VecDeque<PeerId>,
}

impl Service for Greeting {
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
        let to = Destination::Peer(origin.peer);
        context.outbox.send(to, heartbeat::message(&context.vehicle));
        for message in status_text::messages(Severity::Info, INTRODUCTION, &mut 0) {
            context.outbox.send(to, message);
        }
    }
}
