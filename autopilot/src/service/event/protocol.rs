//! EVENT, CURRENT_EVENT_SEQUENCE, REQUEST_EVENT and RESPONSE_EVENT_ERROR.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::{
    CURRENT_EVENT_SEQUENCE_DATA, EVENT_DATA, MavCmd, MavEventCurrentSequenceFlags, MavEventErrorReason,
    MavMessage, RESPONSE_EVENT_ERROR_DATA,
};
use vehicle::{Action, Cause, Severity, Vehicle};

use super::buffer::EventBuffer;
use super::report::{Draft, packed, report};
use crate::codec::{Command, Frame, boot_ms, id};
use crate::context::Context;
use crate::envelope::{Destination, Origin};
use crate::event_catalog::{Event, LogLevel, action_number, cause_number};
use crate::service::{CommandEntry, Outcome, Progress, Service};

const COMMANDS: &[CommandEntry] = &[CommandEntry::action(MavCmd::MAV_CMD_RUN_PREARM_CHECKS as u16)];

/// The number of the latest event is told so often, µs, so that who has missed one asks for it.
const SEQUENCE_PERIOD_US: u64 = 3_000_000;
/// The checks are looked at so often, µs.
const REPORT_PERIOD_US: u64 = 500_000;
/// So many events are sent again for one request: more are not remembered.
const MOST_AGAIN: u16 = 64;

/// Sends events, in PX4's identity.
#[derive(Clone, Debug, Default)]
pub struct Events {
    buffer: EventBuffer,
    reported: Vec<Draft>,
    armed: bool,
    causes: Vec<Cause>,
    sequence_due_us: u64,
    report_due_us: u64,
}

impl Service for Events {
    fn summary(&self) -> &'static str {
        "Health and arming checks, and events with their words in the metadata (PX4)"
    }

    fn messages(&self) -> &'static [u32] {
        &[id::REQUEST_EVENT]
    }

    fn commands(&self) -> &'static [CommandEntry] {
        COMMANDS
    }

    fn answers(&self) -> &'static [u32] {
        &[EVENT_DATA::ID, CURRENT_EVENT_SEQUENCE_DATA::ID, RESPONSE_EVENT_ERROR_DATA::ID]
    }

    fn receive(&mut self, context: &mut Context, origin: &Origin, frame: &Frame) {
        if context.identity().is_ardupilot() {
            return;
        }
        let payload = frame.payload();
        self.send_again(context, origin, payload.u16(0), payload.u16(2));
    }

    /// Tells what speaks against arming, and the whole report anew: who has just come, such as MAVSDK, asks for it.
    fn command(&mut self, context: &mut Context, _origin: &Origin, _command: &Command) -> Outcome {
        say_obstacles(context);
        self.reported.clear();
        self.report_due_us = 0;
        Ok(Progress::Done)
    }

    fn stream(&mut self, context: &mut Context) {
        if context.identity().is_ardupilot() {
            return;
        }
        let time_us = context.vehicle.time_us();
        self.tell_arming(context);
        self.tell_failsafes(context);
        if time_us >= self.report_due_us {
            self.report_due_us = time_us + REPORT_PERIOD_US;
            self.tell_report(context);
        }
        if time_us >= self.sequence_due_us {
            self.sequence_due_us = time_us + SEQUENCE_PERIOD_US;
            context.outbox.send(Destination::Everyone, self.sequence());
        }
    }
}

impl Events {
    /// CURRENT_EVENT_SEQUENCE.
    fn sequence(&self) -> MavMessage {
        let reset = MavEventCurrentSequenceFlags::MAV_EVENT_CURRENT_SEQUENCE_FLAGS_RESET;
        MavMessage::CURRENT_EVENT_SEQUENCE(CURRENT_EVENT_SEQUENCE_DATA {
            sequence: self.buffer.latest(),
            flags: if self.buffer.is_empty() { reset } else { MavEventCurrentSequenceFlags::empty() },
        })
    }

    fn send(&mut self, context: &mut Context, draft: &Draft) {
        let event = self.buffer.push(EVENT_DATA {
            id: draft.event.id(),
            event_time_boot_ms: boot_ms(context.vehicle.time_us()),
            sequence: 0,
            destination_component: 0,
            destination_system: 0,
            log_levels: draft.level.bits(),
            arguments: draft.arguments,
        });
        context.outbox.send(Destination::Everyone, MavMessage::EVENT(event));
    }

    /// The whole report, when it has changed.
    fn tell_report(&mut self, context: &mut Context) {
        if report(&context.vehicle).ne(self.reported.iter().cloned()) {
            self.reported = report(&context.vehicle).collect();
            for draft in self.reported.clone() {
                self.send(context, &draft);
            }
        }
    }

    fn tell_arming(&mut self, context: &mut Context) {
        let armed = context.vehicle.is_armed();
        if armed != self.armed {
            self.armed = armed;
            let event = if armed { Event::Armed } else { Event::Disarmed };
            self.send(context, &Draft { event, level: LogLevel::Info, arguments: packed([]) });
            self.report_due_us = 0;
        }
    }

    /// Causes that have begun or ended, except those that nothing is done about.
    fn tell_failsafes(&mut self, context: &mut Context) {
        if context.vehicle.failsafe().present().eq(self.causes.iter().copied()) {
            return;
        }
        let present: Vec<Cause> = context.vehicle.failsafe().present().collect();
        let before = std::mem::replace(&mut self.causes, present.clone());
        for cause in present.iter().filter(|cause| !before.contains(cause)) {
            let action = action_of(&context.vehicle, *cause);
            if action != Action::None {
                let level = if action > Action::Warn { LogLevel::Critical } else { LogLevel::Warning };
                let arguments = packed([&[cause_number(*cause), action_number(action)]]);
                self.send(context, &Draft { event: Event::FailsafeBegun, level, arguments });
            }
        }
        for cause in before.iter().filter(|cause| !present.contains(cause)) {
            if context.vehicle.conduct().failsafe.action(*cause) != Action::None {
                let arguments = packed([&[cause_number(*cause)]]);
                let draft = Draft { event: Event::FailsafeCleared, level: LogLevel::Info, arguments };
                self.send(context, &draft);
            }
        }
    }

    /// REQUEST_EVENT: a range of numbers again, to who has asked.
    fn send_again(&self, context: &mut Context, origin: &Origin, first: u16, last: u16) {
        let to = Destination::Peer(origin.peer);
        let count = last.wrapping_sub(first).wrapping_add(1);
        // The older ones are not remembered, and named once.
        let skipped = count.saturating_sub(MOST_AGAIN);
        if skipped > 0 {
            context.outbox.send(to, self.unavailable(origin, first));
        }
        for offset in skipped..count {
            let sequence = first.wrapping_add(offset);
            let message = match self.buffer.get(sequence) {
                Some(event) => MavMessage::EVENT(event.clone()),
                None => self.unavailable(origin, sequence),
            };
            context.outbox.send(to, message);
        }
    }

    fn unavailable(&self, origin: &Origin, sequence: u16) -> MavMessage {
        MavMessage::RESPONSE_EVENT_ERROR(RESPONSE_EVENT_ERROR_DATA {
            sequence,
            sequence_oldest_available: self.buffer.oldest(),
            target_system: origin.system,
            target_component: origin.component,
            reason: MavEventErrorReason::MAV_EVENT_ERROR_REASON_UNAVAILABLE,
        })
    }
}

/// Tells the pilot what speaks against arming.
fn say_obstacles(context: &mut Context) {
    let obstacles = context.vehicle.arming_obstacles();
    if obstacles.is_empty() {
        context.say(Severity::Info, "Ready to arm");
    }
    for obstacle in obstacles {
        // Clients of ArduPilot look for its word.
        let when = if context.identity().is_ardupilot() { "PreArm" } else { "Preflight" };
        context.say(Severity::Warning, &format!("{when}: {obstacle}"));
    }
}

/// What is done about a cause: its action, or only a warning if the mode goes on.
fn action_of(vehicle: &Vehicle, cause: Cause) -> Action {
    let action = vehicle.conduct().failsafe.action(cause);
    let engaged = vehicle.failsafe().engaged().is_some_and(|(by, _)| by == cause);
    if engaged { action } else { action.min(Action::Warn) }
}
