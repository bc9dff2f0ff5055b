//! Requests for messages that a link gets regularly.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::{MESSAGE_INTERVAL_DATA, MavCmd, MavMessage};
use vehicle::{Refusal, StreamRates};

use super::schedule::{Interval, Schedule};
use crate::codec::{Command, Frame, id};
use crate::context::Context;
use crate::envelope::{Destination, Origin, PeerId};
use crate::service::message_request::send_once;
use crate::service::{CommandEntry, Outcome, Progress, Service};
use crate::speaker::Speaker;
use crate::stream::{Component, Group, Stream};

const GET_MESSAGE_INTERVAL: u16 = MavCmd::MAV_CMD_GET_MESSAGE_INTERVAL as u16;
const REQUEST_MESSAGE: u16 = MavCmd::MAV_CMD_REQUEST_MESSAGE as u16;
const SET_MESSAGE_INTERVAL: u16 = MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL as u16;

const COMMANDS: &[CommandEntry] = &[
    CommandEntry::question(GET_MESSAGE_INTERVAL),
    CommandEntry::question(REQUEST_MESSAGE),
    CommandEntry::action(SET_MESSAGE_INTERVAL),
];

/// Messages per second of simulation that a link carries at most.
const MOST_PER_S: f64 = 4_000.0;

/// The schedules of all links.
#[derive(Clone, Debug, Default)]
pub struct MessageIntervals {
    links: Vec<Schedule>,
    /// The rates of groups that the parameters had at the last look, and the revision of all of them then.
    rates: StreamRates,
    revision: u64,
}

impl Service for MessageIntervals {
    fn summary(&self) -> &'static str {
        "How often messages are sent"
    }

    fn answers(&self) -> &'static [u32] {
        &[id::MESSAGE_INTERVAL]
    }

    fn messages(&self) -> &'static [u32] {
        &[id::REQUEST_DATA_STREAM]
    }

    fn commands(&self) -> &'static [CommandEntry] {
        COMMANDS
    }

    fn speakers(&self) -> &'static [Speaker] {
        &Speaker::ALL
    }

    /// Each link begins with the rates of its profile.
    fn start(&mut self, context: &mut Context) {
        let time_us = context.vehicle.time_us();
        self.rates = context.vehicle.conduct().stream_rates;
        for (link, profile) in context.links.iter().enumerate() {
            let rates = self.rates.of_link(link);
            self.links.push(Schedule::new(*profile, rates, context.streams.iter(), time_us));
        }
    }

    fn receive(&mut self, context: &mut Context, origin: &Origin, frame: &Frame) {
        self.request_data_stream(context, origin, frame);
    }

    fn command(&mut self, context: &mut Context, origin: &Origin, command: &Command) -> Outcome {
        match command.number {
            GET_MESSAGE_INTERVAL => self.get(context, origin, command.whole(1))?,
            REQUEST_MESSAGE => self.request(context, origin, command)?,
            _ => self.set(context, origin, command)?,
        }
        Ok(Progress::Done)
    }

    /// Rates return to what others want when whoever wanted them is gone.
    fn transfer(&mut self, context: &mut Context, _turns: usize, has_room: &dyn Fn(PeerId) -> Option<bool>) {
        let time_us = context.vehicle.time_us();
        for schedule in &mut self.links {
            schedule.forget(|peer| has_room(peer).is_none(), time_us);
        }
    }

    /// Sends what is due on every link.
    fn stream(&mut self, context: &mut Context) {
        self.follow_parameters(context);
        let Context { vehicle, parameters, outbox, capabilities, .. } = context;
        let component = Component { vehicle, parameters, capabilities: *capabilities };
        let time_us = vehicle.time_us();
        for (link, schedule) in self.links.iter_mut().enumerate() {
            schedule.due(time_us, |stream| {
                if let Some(message) = stream.message(&component) {
                    outbox.send_as(stream.speaker, Destination::Link(link), message);
                } else {
                    for message in stream.messages(&component, 0) {
                        outbox.send_as(stream.speaker, Destination::Link(link), message);
                    }
                }
            });
        }
        context.quiet_until_us = self.links.iter().map(Schedule::quiet_until_us).min().unwrap_or(u64::MAX);
    }
}

impl MessageIntervals {
    /// Parameters of rates hold at once.
    fn follow_parameters(&mut self, context: &Context) {
        let revision = context.vehicle.conduct_revision();
        if std::mem::replace(&mut self.revision, revision) == revision {
            return;
        }
        let rates = context.vehicle.conduct().stream_rates;
        if rates == self.rates {
            return;
        }
        self.rates = rates;
        let time_us = context.vehicle.time_us();
        for (link, schedule) in self.links.iter_mut().enumerate() {
            schedule.change_rates(rates.of_link(link), context.streams.iter(), time_us);
        }
    }

    /// MAV_CMD_SET_MESSAGE_INTERVAL on the sender's link: µs, 0 for the default, −1 for never.
    fn set(&mut self, context: &Context, origin: &Origin, command: &Command) -> Result<(), Refusal> {
        let number = command.whole(1).ok_or_else(|| Refusal::denied("Message number required"))?;
        let unknown = || Refusal::Unsupported(format!("Message {number} cannot be streamed"));
        let link = origin.peer.link;
        let stream = context.streams.get(number).filter(|stream| stream.is_regular()).ok_or_else(unknown)?;
        let schedule = self.links.get_mut(link).ok_or_else(unknown)?;
        let interval = match command.parameter(2) {
            value if value.is_nan() => {
                return Err(Refusal::denied(
                    "Message interval denied: NaN; send microseconds, 0 (default) or -1 (never)",
                ));
            }
            0.0 => Interval::Default,
            interval_us if interval_us > 0.0 => Interval::Each(interval_us as u64),
            _ => Interval::Never,
        };
        let per_s = schedule.per_s_with(stream, schedule.resolved_us(stream, interval));
        if per_s > MOST_PER_S {
            return Err(Refusal::denied(format!(
                "Message interval denied: {per_s:.0} messages/s on this link; at most {MOST_PER_S}"
            )));
        }
        schedule.set(origin.peer, stream, interval, context.vehicle.time_us());
        Ok(())
    }

    /// MAV_CMD_GET_MESSAGE_INTERVAL: MESSAGE_INTERVAL, 0 for a message that there is not, −1 for one that the link does
    /// not get.
    fn get(&self, context: &mut Context, origin: &Origin, number: Option<u32>) -> Result<(), Refusal> {
        let Some(Ok(message_id)) = number.map(u16::try_from) else {
            return Err(Refusal::denied("Message number must be from 0 to 65535"));
        };
        let number = u32::from(message_id);
        let interval_us = if context.streams.get(number).is_some_and(Stream::is_regular) {
            let schedule = self.links.get(origin.peer.link);
            schedule
                .and_then(|schedule| schedule.interval_us(number))
                .map_or(-1, |interval_us| interval_us as i32)
        } else {
            0
        };
        let message = MavMessage::MESSAGE_INTERVAL(MESSAGE_INTERVAL_DATA { interval_us, message_id });
        context.outbox.send(Destination::Peer(origin.peer), message);
        Ok(())
    }

    /// MAV_CMD_REQUEST_MESSAGE: any message of the table, or the interval of the one that parameter 2 names.
    fn request(&self, context: &mut Context, origin: &Origin, command: &Command) -> Result<(), Refusal> {
        let id = command.whole(1).ok_or_else(|| Refusal::denied("Message number required"))?;
        match id {
            MESSAGE_INTERVAL_DATA::ID => self.get(context, origin, command.whole(2)),
            _ => {
                let asked = Speaker::of(command.component).unwrap_or_default();
                send_once(context, origin, asked, id, command.whole(2).unwrap_or(0))
            }
        }
    }

    /// REQUEST_DATA_STREAM, the old way: one group or all of them.
    fn request_data_stream(&mut self, context: &Context, origin: &Origin, frame: &Frame) {
        let payload = frame.payload();
        let (rate_hz, number, start) = (payload.u16(0), payload.u8(4), payload.u8(5) != 0);
        let Some(schedule) = self.links.get_mut(origin.peer.link) else { return };
        // All streams of the table at this interval are what a link carries.
        let least_us = (context.streams.iter().count() as f64 * 1e6 / MOST_PER_S) as u64;
        let interval = if start && rate_hz > 0 {
            Interval::Each((1_000_000 / u64::from(rate_hz)).max(least_us))
        } else {
            Interval::Never
        };
        for group in Group::ALL.into_iter().filter(|group| number == 0 || number == *group as u8) {
            for stream in context.streams.iter().filter(|stream| stream.group == Some(group)) {
                schedule.set(origin.peer, stream, interval, context.vehicle.time_us());
            }
        }
    }
}
