//! What a client says when it uploads a plan.

#![allow(deprecated)] // Clients still use what the dialect calls deprecated.

use autopilot::codec::{Message, MissionItemMessage, Target};
use mavlink::dialects::ardupilotmega::{MISSION_ACK_DATA, MISSION_COUNT_DATA, MavMessage, MavMissionType};
use vehicle::plan::{MissionItem, PlanKind, command, frame};

use super::Bench;

pub fn mission_type(kind: PlanKind) -> MavMissionType {
    match kind {
        PlanKind::Mission => MavMissionType::MAV_MISSION_TYPE_MISSION,
        PlanKind::Fence => MavMissionType::MAV_MISSION_TYPE_FENCE,
        PlanKind::Rally => MavMissionType::MAV_MISSION_TYPE_RALLY,
    }
}

pub fn item_message(kind: PlanKind, sequence: usize, item: MissionItem, int: bool) -> Message {
    Message::MissionItem(MissionItemMessage {
        sequence: sequence as u16,
        item,
        current: 0,
        kind: kind.number(),
        target: Target { system: 1, component: 1 },
        int,
    })
}

pub fn count_message(kind: PlanKind, count: usize) -> MavMessage {
    MavMessage::MISSION_COUNT(MISSION_COUNT_DATA {
        count: count as u16,
        target_system: 1,
        target_component: 1,
        mission_type: mission_type(kind),
        opaque_id: 0,
    })
}

/// The number of an item that is asked for.
pub fn request_of(message: &Message) -> Option<u16> {
    match message {
        Message::Typed(MavMessage::MISSION_REQUEST_INT(request)) => Some(request.seq),
        Message::Typed(MavMessage::MISSION_REQUEST(request)) => Some(request.seq),
        _ => None,
    }
}

pub fn ack_of(message: &Message) -> Option<MISSION_ACK_DATA> {
    match message {
        Message::Typed(MavMessage::MISSION_ACK(ack)) => Some(ack.clone()),
        _ => None,
    }
}

pub fn result(heard: &[Message]) -> Option<u8> {
    heard.iter().find_map(ack_of).map(|ack| ack.mavtype as u8)
}

/// Uploads a plan over a good channel, and returns what is heard at the end.
pub fn upload(bench: &mut Bench, kind: PlanKind, items: &[MissionItem]) -> Vec<Message> {
    let send = |bench: &mut Bench, message: Message| {
        bench.heard.clear();
        let frame = bench.frame(message);
        bench.receive(&frame);
        std::mem::take(&mut bench.heard)
    };
    let mut heard = send(bench, count_message(kind, items.len()).into());
    while let Some(sequence) = heard.iter().find_map(request_of) {
        heard = send(bench, item_message(kind, sequence.into(), items[usize::from(sequence)], true));
    }
    heard
}

/// A waypoint so far north of the origin, at an altitude above home, m.
pub fn waypoint(north: f64, altitude: f64) -> MissionItem {
    MissionItem {
        frame: frame::GLOBAL_RELATIVE_INT,
        command: command::NAV_WAYPOINT,
        parameters: [0.0, 2.0, 0.0, f64::NAN],
        // A whole number of the message's units.
        position: [f64::from(473_977_420 + (north * 90.0) as i32) / 1e7, 85_455_940.0 / 1e7, altitude],
        autocontinue: true,
    }
}

/// Items of a kind that are taken.
pub fn items(kind: PlanKind, count: usize) -> Vec<MissionItem> {
    let item = |index: usize| {
        let waypoint = waypoint(index as f64, 10.0 + index as f64);
        match kind {
            PlanKind::Mission => waypoint,
            PlanKind::Fence => MissionItem {
                command: command::NAV_FENCE_CIRCLE_INCLUSION,
                parameters: [80.0 + index as f64, 0.0, 0.0, 0.0],
                ..waypoint
            },
            PlanKind::Rally => {
                MissionItem { command: command::NAV_RALLY_POINT, parameters: [0.0; 4], ..waypoint }
            }
        }
    };
    (0..count).map(item).collect()
}
