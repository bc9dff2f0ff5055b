//! How a command becomes an answer: its service carries it out, unless it is a retry of what was carried out already.

use mavlink::dialects::ardupilotmega::MavProtocolCapability;
use vehicle::Severity;

use super::acknowledgement::{acknowledge, acknowledge_outcome, result_of};
use super::retry::Retries;
use crate::codec::{Command, Frame};
use crate::context::Context;
use crate::envelope::Origin;
use crate::service::{Outcome, Repetition, Service};

/// The protocol, with the commands that were carried out lately.
#[derive(Clone, Debug, Default)]
pub struct CommandProtocol {
    retries: Retries,
}

impl CommandProtocol {
    /// What AUTOPILOT_VERSION tells of it.
    pub fn capabilities(&self) -> MavProtocolCapability {
        MavProtocolCapability::MAV_PROTOCOL_CAPABILITY_COMMAND_INT
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
