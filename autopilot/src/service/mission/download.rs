//! Downloads: the count, then item by item whatever is asked for.

use mavlink::dialects::ardupilotmega::{MISSION_COUNT_DATA, MavMessage};
use vehicle::plan::{FaultCode, PlanFault, PlanKind};

use super::answer;
use crate::codec::{Frame, Message, MissionItemMessage, Target, id};
use crate::context::Context;
use crate::envelope::{Destination, Origin};

/// MISSION_REQUEST_LIST: how many items there are, and the id of the plan.
pub fn request_list(context: &mut Context, origin: &Origin, frame: &Frame) {
    let number = frame.payload().u8(2);
    let Some(kind) = PlanKind::of(number) else {
        answer::refused(context, origin, number, FaultCode::Invalid);
        return;
    };
    let plan = context.vehicle.plans().get(kind);
    let message = MavMessage::MISSION_COUNT(MISSION_COUNT_DATA {
        count: u16::try_from(plan.items().len()).unwrap_or(u16::MAX),
        target_system: origin.system,
        target_component: origin.component,
        mission_type: answer::kind_of(number),
        opaque_id: plan.id(),
    });
    context.outbox.send(Destination::Peer(origin.peer), message);
}

/// MISSION_REQUEST_INT and the older MISSION_REQUEST: one item, in the message that goes with the request.
pub fn request(context: &mut Context, origin: &Origin, frame: &Frame) {
    let payload = frame.payload();
    let (sequence, number) = (payload.u16(0), payload.u8(4));
    let Some(kind) = PlanKind::of(number) else {
        answer::refused(context, origin, number, FaultCode::Invalid);
        return;
    };
    let Some(item) = context.vehicle.plan_item(kind, usize::from(sequence)) else {
        let count = context.vehicle.plans().get(kind).items().len();
        let reason = format!("no item has sequence number {sequence}; the plan has {count} items");
        let fault = PlanFault::of_plan(FaultCode::InvalidSequence, reason);
        answer::refused_aloud(context, origin, number, &fault);
        return;
    };
    let home = context.vehicle.identity().is_ardupilot().then_some(0);
    let flown = Some(context.vehicle.mission_status().current)
        .filter(|current| kind == PlanKind::Mission && Some(*current) != home);
    let message = MissionItemMessage {
        sequence,
        item,
        current: u8::from(flown == Some(usize::from(sequence))),
        kind: number,
        target: Target { system: origin.system, component: origin.component },
        int: frame.message_id() == id::MISSION_REQUEST_INT,
    };
    context.outbox.send(Destination::Peer(origin.peer), Message::MissionItem(message));
}

/// MISSION_REQUEST_PARTIAL_LIST: no part of the protocol any more; who asks is told so.
pub fn request_partial_list(context: &mut Context, origin: &Origin, frame: &Frame) {
    answer::refused(context, origin, frame.payload().u8(6), FaultCode::Unsupported);
}
