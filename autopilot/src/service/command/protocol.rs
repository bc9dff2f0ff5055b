//! How a command becomes an answer: its service carries it out, unless it is a retry of what was carried out already.

use std::collections::BTreeSet;

use mavlink::dialects::ardupilotmega::MavProtocolCapability;
use vehicle::Severity;

use super::acknowledgement::{acknowledge, acknowledge_outcome, refuse_in_place_of, result_of};
use super::retry::Retries;
use crate::codec::{Command, Frame, target_of};
use crate::context::Context;
use crate::envelope::Origin;
use crate::service::{Outcome, Repetition, Service};

/// The protocol, with the commands that were carried out lately.
#[derive(Clone, Debug, Default)]
pub struct CommandProtocol {
    retries: Retries,
    /// Other components of this system that have been heard: they answer for themselves.
    others: BTreeSet<u8>,
}

impl CommandProtocol {
    /// What AUTOPILOT_VERSION tells of it.
    pub fn capabilities(&self) -> MavProtocolCapability {
        MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_COMMAND_INT
    }

    /// Takes in who is there.
    pub fn hear(&mut self, system: u8, origin: &Origin) {
        if origin.system == system {
            self.others.insert(origin.component);
        }
    }

    /// Refuses a command to a component of this system that is not there, so that nobody waits for it.
    pub fn refuse_for_absent(&self, context: &mut Context, origin: &Origin, frame: &Frame) {
        let target = target_of(frame);
        let absent = target.system == context.system_id() && !self.others.contains(&target.component);
        if let Some(command) = Command::read(frame).filter(|_| absent) {
            refuse_in_place_of(&mut context.outbox, target.component, origin, command.number);
        }
    }

    /// Has a command carried out by the service that takes it, and answers it. Every command is answered, before
    /// everything that it makes the vehicle send.
    pub fn handle(
        &mut self,
        context: &mut Context,
        origin: &Origin,
        frame: &Frame,
        command: &Command,
        taker: Option<(Repetition, &mut dyn Service)>,
    ) {
        let mark = context.outbox.mark();
        let time_us = context.vehicle.time_us();
        let repetition = taker.as_ref().map_or(Repetition::Once, |(repetition, _)| *repetition);
        let once = repetition == Repetition::Once;
        if once && let Some(result) = self.retries.answer(origin, command, frame.sequence(), time_us) {
            acknowledge(&mut context.outbox, origin, command.number, result);
            return;
        }
        let outcome = taker.map(|(_, service)| service.command(context, origin, command));
        let result = result_of(outcome.as_ref());
        if once {
            self.retries.remember(origin, command, frame.sequence(), time_us, result);
        }
        acknowledge_outcome(&mut context.outbox, origin, command.number, outcome.as_ref());
        context.outbox.last_to(mark);
        if let Some(outcome) = outcome.filter(|_| once) {
            explain(context, &outcome);
        }
    }
}

/// Says why something was refused.
pub fn explain(context: &mut Context, outcome: &Outcome) {
    if let Err(refusal) = outcome {
        context.say(Severity::Warning, &refusal.to_string());
    }
}
