//! What a service is.

use std::fmt::Debug;

use mavlink::dialects::ardupilotmega::MavProtocolCapability;
use vehicle::Refusal;
use vehicle::identity::Identity;

use crate::codec::{Command, Frame};
use crate::context::Context;
use crate::envelope::{Origin, PeerId};
use crate::speaker::Speaker;
use crate::stream::Stream;

/// How a command that arrives twice is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Repetition {
    /// It asks for something: it is carried out again, because the first answer may be what was lost. Its refusal is not told
    /// to the pilot: clients probe.
    Again,
    /// It changes something: it is carried out once and answered again. Its refusal is told to the pilot.
    Once,
}

/// A command that a service takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CommandEntry {
    /// MAV_CMD.
    pub number: u16,
    /// What a second one means.
    pub repetition: Repetition,
}

impl CommandEntry {
    /// A command that asks for something.
    pub const fn question(number: u16) -> Self {
        Self { number, repetition: Repetition::Again }
    }

    /// A command that changes something.
    pub const fn action(number: u16) -> Self {
        Self { number, repetition: Repetition::Once }
    }
}

/// How far a command is that was not refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// Carried out.
    Done,
    /// Under way, percent: the service answers again when it is over.
    Percent(u8),
}

/// What a service answers to a command.
pub type Outcome = Result<Progress, Refusal>;

/// A MAVLink microservice: it claims messages, commands and streams, and owns what it remembers. It reaches the vehicle and the
/// clients through the [`Context`] of each call. Every method has a default that does nothing, so a service implements only what it
/// needs; those that are called each tick say so ([`Context::rests`]), and are not called again.
pub trait Service: Debug + Send {
    /// What it is for, in a few words: the table of compatibility in the book shows them beside everything that it claims. A service
    /// that claims something needs one.
    fn summary(&self) -> &'static str {
        ""
    }

    /// Identifiers of the messages that it takes. No two services take the same.
    fn messages(&self) -> &'static [u32] {
        &[]
    }

    /// Messages of other systems that it looks at, too: another service may take them.
    fn listens(&self) -> &'static [u32] {
        &[]
    }

    /// Commands that it takes. No two services take the same.
    fn commands(&self) -> &'static [CommandEntry] {
        &[]
    }

    /// Components whose messages and commands it takes.
    fn speakers(&self) -> &'static [Speaker] {
        &[Speaker::Autopilot]
    }

    /// Messages that clients can get from it, once or regularly. No two services have the same.
    fn streams(&self) -> &'static [Stream] {
        &[]
    }

    /// Messages that it sends besides its streams: answers, and news of what has changed.
    fn answers(&self) -> &'static [u32] {
        &[]
    }

    /// Capabilities that it adds to AUTOPILOT_VERSION in the terms of an identity.
    fn capabilities(&self, _identity: Identity) -> MavProtocolCapability {
        MavProtocolCapability::empty()
    }

    /// Called once, when the vehicle has just started.
    fn start(&mut self, _context: &mut Context) {}

    /// Called for every received frame, whoever it is for, before it is handed to its service.
    fn hear(&mut self, _context: &mut Context, _origin: &Origin) {}

    /// Takes in one of the messages that it claims, or listens to.
    fn receive(&mut self, _context: &mut Context, _origin: &Origin, _frame: &Frame) {}

    /// Carries out one of the commands that it claims. The acknowledgement is sent for it, ahead of everything that it sends here.
    ///
    /// # Errors
    /// [`Refusal`], with the reason for the pilot.
    fn command(&mut self, _context: &mut Context, _origin: &Origin, _command: &Command) -> Outcome {
        Err(Refusal::Unsupported("not supported".to_owned()))
    }

    /// Whether it is to be called after every tick, because it acts on the vehicle at a time of its own. Otherwise a vehicle that rests may fly
    /// several at once.
    fn is_busy(&self) -> bool {
        false
    }

    /// Called after each tick of the vehicle, or after several.
    fn tick(&mut self, context: &mut Context) {
        context.rests = true;
    }

    /// Called after each tick and each received message: tells clients what has changed.
    fn announce(&mut self, context: &mut Context) {
        context.rests = true;
    }

    /// Called at the end of each tick: sends what is due regularly.
    fn stream(&mut self, context: &mut Context) {
        context.rests = true;
    }

    /// Whether a long answer is under way, be it that others work on it. Otherwise it does not matter when [`Self::transfer`] is called next.
    fn is_answering(&self) -> bool {
        false
    }

    /// Goes on with long answers: sends as many messages as this service allows itself in `turns` turns, about 2500 of which make a
    /// second of the wall clock, to peers whose link has room (`None`: the peer is gone), one peer after the other.
    fn transfer(&mut self, context: &mut Context, _turns: usize, _has_room: &dyn Fn(PeerId) -> Option<bool>) {
        context.rests = true;
    }
}
