//! What a service is.

use std::fmt::Debug;

use mavlink::dialects::common::MavProtocolCapability;
use vehicle::Refusal;
use vehicle::identity::Identity;

use super::{Origin, PeerId};
use crate::codec::{Command, Frame};
use crate::context::Context;
use crate::stream::Stream;

/// How a command that arrives twice is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Repetition {
    /// It asks for something: it is carried out again, because the first answer may be what was lost. Its refusal is
    /// no news for the pilot: clients probe.
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

/// What becomes of a command.
pub type Outcome = Result<Progress, Refusal>;

/// A MAVLink microservice: it says what it takes, and owns what it remembers. It reaches the vehicle and its clients by the
/// [`Context`] that each call brings, and no other service.
pub trait Service: Debug + Send {
    /// Identifiers of the messages that it takes. No two services take the same.
    fn messages(&self) -> &'static [u32] {
        &[]
    }

    /// Commands that it takes. No two services take the same.
    fn commands(&self) -> &'static [CommandEntry] {
        &[]
    }

    /// Messages that clients can ask of it, once or regularly.
    fn streams(&self) -> &'static [Stream] {
        &[]
    }

    /// What AUTOPILOT_VERSION tells that it can do, in the terms of an identity.
    fn capabilities(&self, _identity: Identity) -> MavProtocolCapability {
        MavProtocolCapability::empty()
    }

    /// The vehicle has just started.
    fn start(&mut self, _context: &mut Context) {}

    /// Somebody was heard, whoever the message is for.
    fn hear(&mut self, _context: &mut Context, _origin: &Origin) {}

    /// Takes one of its messages in.
    fn receive(&mut self, _context: &mut Context, _origin: &Origin, _frame: &Frame) {}

    /// Carries one of its commands out. The answer is sent for it, before everything that it sends here.
    ///
    /// # Errors
    /// [`Refusal`], with the reason for the pilot.
    fn command(&mut self, _context: &mut Context, _origin: &Origin, _command: &Command) -> Outcome {
        Err(Refusal::Unsupported("not supported".to_owned()))
    }

    /// A tick of simulation time is over.
    fn tick(&mut self, _context: &mut Context) {}

    /// A tick or a message is over: what has changed by it is told.
    fn announce(&mut self, _context: &mut Context) {}

    /// What is due regularly is sent, after all changes of the tick.
    fn stream(&mut self, _context: &mut Context) {}

    /// Sends up to this many messages of what is long, to peers that have room for them (`None`: the peer is gone). It
    /// is called at the pace of links and wall clocks, not of the flight.
    fn transfer(
        &mut self,
        _context: &mut Context,
        _messages: usize,
        _has_room: &dyn Fn(PeerId) -> Option<bool>,
    ) {
    }
}
