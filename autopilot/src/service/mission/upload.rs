//! Uploads: one at a time, item by item in order; the vehicle asks for each.

use mavlink::dialects::ardupilotmega::{
    MISSION_REQUEST_DATA, MISSION_REQUEST_INT_DATA, MavMessage, MavMissionResult,
};
use vehicle::Severity;
use vehicle::parameters::Speed;
use vehicle::plan::{FaultCode, MissionItem, PlanFault, PlanKind, check};

use super::answer;
use super::guided_item;
use super::reservation::Reservation;
use crate::codec::{Frame, MissionItemMessage};
use crate::context::Context;
use crate::envelope::{Destination, Origin};

/// An item is asked for again after this long, µs, as the protocol recommends.
const RETRY_US: f64 = 250_000.0;
/// So often; PX4 waits for as long in all.
const MOST_RETRIES: u32 = 20;
/// A client that has never answered MISSION_REQUEST_INT after so many may know only the older MISSION_REQUEST, and the other way round.
const OLDER_AFTER: u32 = 4;
/// Pace that is counted on when time runs as fast as it can.
const FULL_SPEED: f64 = 100.0;
/// For this long, µs, late copies of an upload's messages are recognized.
const REMEMBERED_US: u64 = 10_000_000;

/// The upload that is under way, and the one before it.
#[derive(Clone, Debug, Default)]
pub struct Uploads {
    receiving: Option<Upload>,
    finished: Option<Finished>,
    reservation: Reservation,
}

/// An upload under way.
#[derive(Clone, Debug)]
struct Upload {
    origin: Origin,
    kind: PlanKind,
    /// Whether the other items of the plan stay.
    partial: bool,
    /// Numbers of the items that are written.
    first: usize,
    end: usize,
    items: Vec<MissionItem>,
    /// Frame that began it: a copy of it begins nothing.
    begun_by: u8,
    /// Whether the client has answered with MISSION_ITEM_INT, or with the older MISSION_ITEM.
    int: Option<bool>,
    asked_us: u64,
    retries: u32,
}

/// An upload that is over.
#[derive(Clone, Debug)]
struct Finished {
    origin: Origin,
    kind: PlanKind,
    begun_by: u8,
    last: Option<usize>,
    /// The answer, to be given again if it was lost.
    answer: Result<u32, FaultCode>,
    time_us: u64,
}

impl Upload {
    fn next(&self) -> usize {
        self.first + self.items.len()
    }
}

impl Uploads {
    /// Whether one is being received: it is given up at a time of its own.
    pub fn are_under_way(&self) -> bool {
        self.receiving.is_some()
    }

    /// MISSION_COUNT: an upload begins.
    pub fn count(&mut self, context: &mut Context, origin: &Origin, frame: &Frame) {
        let payload = frame.payload();
        self.begin(context, origin, frame, payload.u8(4), None, usize::from(payload.u16(0)));
    }

    /// MISSION_WRITE_PARTIAL_LIST: items of the plan are replaced, others may follow behind them.
    pub fn write_partial_list(&mut self, context: &mut Context, origin: &Origin, frame: &Frame) {
        let payload = frame.payload();
        let (start, end, number) = (payload.i16(0), payload.i16(2), payload.u8(6));
        let there = PlanKind::of(number).map_or(0, |kind| context.vehicle.plans().get(kind).items().len());
        match (usize::try_from(start), usize::try_from(end)) {
            (Ok(first), Ok(last)) if first <= last && first <= there => {
                self.begin(context, origin, frame, number, Some(first), last + 1);
            }
            _ => {
                let reason = format!("cannot write items {start} to {end}; the plan has {there}");
                let fault = PlanFault::of_plan(FaultCode::InvalidSequence, reason);
                answer::refused_aloud(context, origin, number, &fault);
            }
        }
    }

    fn begin(
        &mut self,
        context: &mut Context,
        origin: &Origin,
        frame: &Frame,
        number: u8,
        partial_from: Option<usize>,
        end: usize,
    ) {
        let Some(kind) = PlanKind::of(number) else {
            answer::refused(context, origin, number, FaultCode::Invalid);
            return;
        };
        if self.is_copy(context, origin, kind, frame.sequence()) {
            return;
        }
        self.give_way(context, origin);
        if self.denied(context, origin, number) {
            return;
        }
        if end > kind.capacity() {
            let reason = format!("{end} items; at most {} fit", kind.capacity());
            let fault = PlanFault::of_plan(FaultCode::NoSpace, reason);
            answer::refused_aloud(context, origin, number, &fault);
            return;
        }
        self.reservation.begin(origin.peer, context.vehicle.time_us());
        self.receiving = Some(Upload {
            origin: *origin,
            kind,
            partial: partial_from.is_some(),
            first: partial_from.unwrap_or(0),
            end,
            items: Vec::new(),
            begun_by: frame.sequence(),
            int: None,
            asked_us: 0,
            retries: 0,
        });
        self.go_on(context);
    }

    /// Whether a message that begins an upload is a late copy of one that did.
    fn is_copy(&self, context: &Context, origin: &Origin, kind: PlanKind, sequence: u8) -> bool {
        let time_us = context.vehicle.time_us();
        let under_way = self
            .receiving
            .as_ref()
            .is_some_and(|upload| (upload.origin, upload.kind, upload.begun_by) == (*origin, kind, sequence));
        let over = self.finished.as_ref().is_some_and(|finished| {
            (finished.origin, finished.kind, finished.begun_by) == (*origin, kind, sequence)
                && time_us - finished.time_us < REMEMBERED_US
        });
        under_way || over
    }

    /// Ends an upload that does not get on, or is begun again and again, when another client wants to upload.
    fn give_way(&mut self, context: &mut Context, origin: &Origin) {
        let (time_us, pace) = (context.vehicle.time_us(), pace(context));
        let gives_way = self.receiving.as_ref().is_some_and(|upload| {
            upload.origin != *origin && self.reservation.must_yield(upload.items.len(), time_us, pace)
        });
        if gives_way {
            let reason = "upload took too long while another client was waiting";
            self.fail(context, &PlanFault::of_plan(FaultCode::Cancelled, reason));
        }
    }

    /// Refuses what would disturb somebody else's upload.
    fn denied(&self, context: &mut Context, origin: &Origin, number: u8) -> bool {
        let foreign = self.receiving.as_ref().is_some_and(|upload| upload.origin != *origin);
        if foreign {
            let fault = PlanFault::of_plan(FaultCode::Denied, "another client is uploading");
            answer::refused_aloud(context, origin, number, &fault);
        }
        foreign
    }

    /// Asks for the next item, or takes the plan over if there is none left.
    fn go_on(&mut self, context: &mut Context) {
        let Some(upload) = &mut self.receiving else { return };
        if upload.next() < upload.end {
            upload.retries = 0;
            self.ask(context);
            return;
        }
        let Upload { kind, partial, first, end, .. } = *upload;
        let items = std::mem::take(&mut upload.items);
        let taken = if partial {
            let mut plan = context.vehicle.plans().get(kind).items().to_vec();
            let end = end.min(plan.len());
            plan.splice(first.min(end)..end, items);
            context.vehicle.amend_plan(kind, plan)
        } else {
            context.vehicle.set_plan(kind, items)
        };
        match taken {
            Ok(()) => {
                let id = context.vehicle.plans().get(kind).id();
                self.finish(context, Ok(id));
            }
            Err(fault) => self.fail(context, &fault),
        }
    }

    /// Asks for the next item. Clients differ in which of the two requests they understand.
    fn ask(&mut self, context: &mut Context) {
        let time_us = context.vehicle.time_us();
        let ardupilot = context.identity().is_ardupilot();
        let Some(upload) = &mut self.receiving else { return };
        upload.asked_us = time_us;
        let older = match upload.int {
            // ArduPilot asks like this whatever it is answered; who knows the newer request only is asked by it in the end.
            _ if ardupilot => upload.retries < OLDER_AFTER || upload.retries % 2 == 0,
            Some(true) => false,
            // Some answer either request with the older item.
            Some(false) => upload.retries % 2 == 0,
            None => upload.retries >= OLDER_AFTER && upload.retries % 2 == 0,
        };
        let Origin { peer, system: target_system, component: target_component } = upload.origin;
        let seq = u16::try_from(upload.next()).unwrap_or(u16::MAX);
        let mission_type = answer::kind_of(upload.kind.number());
        let message = if older {
            let request = MISSION_REQUEST_DATA { seq, target_system, target_component, mission_type };
            MavMessage::MISSION_REQUEST(request)
        } else {
            let request = MISSION_REQUEST_INT_DATA { seq, target_system, target_component, mission_type };
            MavMessage::MISSION_REQUEST_INT(request)
        };
        context.outbox.send(Destination::Peer(peer), message);
    }

    /// MISSION_ITEM_INT or MISSION_ITEM.
    pub fn item(&mut self, context: &mut Context, origin: &Origin, frame: &Frame) {
        let Some(message) = MissionItemMessage::read(frame) else { return };
        if context.identity().is_ardupilot() && guided_item::is_one(&message) {
            guided_item::take(context, origin, &message);
            return;
        }
        let sequence = usize::from(message.sequence);
        let own = self.receiving.as_mut().filter(|upload| upload.origin == *origin);
        let Some(upload) = own else {
            self.unexpected(context, origin, &message);
            return;
        };
        if message.kind != upload.kind.number() {
            let wrong =
                format!("item of type {} in an upload of type {}", message.kind, upload.kind.number());
            self.fail(context, &PlanFault::of_item(sequence, FaultCode::Invalid, wrong));
            return;
        }
        let next = upload.next();
        if sequence != next {
            // A copy of an earlier one needs no answer; one that came too early has lost its predecessor.
            if sequence > next && sequence < upload.end {
                self.ask(context);
            }
            return;
        }
        upload.int = Some(message.int);
        let kind = upload.kind;
        match check::item(kind, sequence, &message.item, &context.vehicle.site()) {
            Ok(()) => {
                if let Some(upload) = &mut self.receiving {
                    upload.items.push(message.item);
                }
                self.go_on(context);
            }
            Err(fault) => self.fail(context, &fault),
        }
    }

    /// An item that nobody has asked this client for: a copy, or its upload is over and it has not heard so.
    fn unexpected(&self, context: &mut Context, origin: &Origin, message: &MissionItemMessage) {
        let time_us = context.vehicle.time_us();
        let own = self.finished.as_ref().filter(|finished| {
            finished.origin == *origin
                && finished.kind.number() == message.kind
                && time_us - finished.time_us < REMEMBERED_US
        });
        let Some(finished) = own else {
            if !self.denied(context, origin, message.kind) {
                answer::refused(context, origin, message.kind, FaultCode::Error);
            }
            return;
        };
        if finished.last == Some(usize::from(message.sequence)) {
            let answer = finished.answer;
            repeat(context, origin, message.kind, answer);
        }
    }

    /// MISSION_ACK from a client: the end of a download, or the cancellation of its upload.
    pub fn acknowledge(&mut self, context: &mut Context, origin: &Origin, frame: &Frame) {
        let payload = frame.payload();
        let (result, number) = (payload.u8(2), payload.u8(3));
        let own = self
            .receiving
            .as_ref()
            .is_some_and(|upload| upload.origin == *origin && upload.kind.number() == number);
        if own && result != MavMissionResult::MAV_MISSION_ACCEPTED as u8 {
            self.receiving = None;
            self.reservation.end(false, context.vehicle.time_us());
            let name = PlanKind::of(number).map_or("Plan", PlanKind::name);
            context.say(Severity::Info, &format!("{name} upload cancelled by the client"));
        }
    }

    /// MISSION_CLEAR_ALL: of one kind or of all.
    pub fn clear_all(&mut self, context: &mut Context, origin: &Origin, frame: &Frame) {
        let number = frame.payload().u8(2);
        let kinds: Vec<PlanKind> = match PlanKind::of(number) {
            Some(kind) => vec![kind],
            None if number == PlanKind::NUMBER_OF_ALL => PlanKind::ALL.to_vec(),
            None => {
                answer::refused(context, origin, number, FaultCode::Invalid);
                return;
            }
        };
        self.give_way(context, origin);
        if self.denied(context, origin, number) {
            return;
        }
        if kinds.contains(&PlanKind::Mission) && context.vehicle.keeps_mission() {
            let fault = PlanFault::of_plan(FaultCode::Error, "the mission is being flown; leave Auto first");
            answer::refused_aloud(context, origin, number, &fault);
            return;
        }
        // Whoever clears has given its own upload up.
        self.receiving = None;
        self.reservation.end(true, context.vehicle.time_us());
        for kind in kinds {
            if let Err(fault) = context.vehicle.set_plan(kind, Vec::new()) {
                answer::refused_aloud(context, origin, number, &fault);
                return;
            }
        }
        answer::accepted(context, origin, number, 0);
    }

    /// Asks again for what has not come, and gives up in the end. The client lives by the wall clock: when simulation time runs
    /// faster, it has as many seconds of its own.
    pub fn update(&mut self, context: &mut Context) {
        let pace = pace(context);
        let Some(upload) = &mut self.receiving else { return };
        let silent_us = context.vehicle.time_us() - upload.asked_us;
        if silent_us < (RETRY_US * pace) as u64 {
            return;
        }
        if upload.retries < MOST_RETRIES {
            upload.retries += 1;
            self.ask(context);
            return;
        }
        let fault = PlanFault::of_item(upload.next(), FaultCode::Cancelled, "did not come, upload given up");
        self.fail(context, &fault);
    }

    /// Ends an upload with the old plan in force.
    fn fail(&mut self, context: &mut Context, fault: &PlanFault) {
        let Some(upload) = &self.receiving else { return };
        let name = upload.kind.name();
        self.finish(context, Err(fault.code));
        context.reject_plan(name, fault);
    }

    fn finish(&mut self, context: &mut Context, answer: Result<u32, FaultCode>) {
        let time_us = context.vehicle.time_us();
        let Some(upload) = self.receiving.take() else { return };
        self.reservation.end(answer.is_ok(), time_us);
        let Upload { origin, kind, begun_by, .. } = upload;
        // With the plan taken over, its items have left the upload.
        let last = if answer.is_ok() { upload.end.checked_sub(1) } else { Some(upload.next()) };
        self.finished = Some(Finished { origin, kind, begun_by, last, answer, time_us });
        repeat(context, &origin, kind.number(), answer);
    }
}

/// How much faster simulation time may run than the clients' clocks.
fn pace(context: &Context) -> f64 {
    match context.parameters.speed() {
        Speed::Paused => 1.0,
        Speed::Factor(factor) => factor.max(1.0),
        Speed::Max => FULL_SPEED,
    }
}

fn repeat(context: &mut Context, origin: &Origin, number: u8, answer: Result<u32, FaultCode>) {
    match answer {
        Ok(id) => answer::accepted(context, origin, number, id),
        Err(code) => answer::refused(context, origin, number, code),
    }
}
