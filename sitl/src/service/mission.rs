//! Missions are not flown by this vehicle: who asks is told so at once.

use mavlink::dialects::common::{
    MISSION_ACK_DATA, MISSION_COUNT_DATA, MavMessage, MavMissionResult, MavMissionType,
};

use super::{Destination, Origin};
use crate::autopilot::Autopilot;
use crate::codec::{Frame, id};

/// A download of none, a refused upload.
pub fn answer(autopilot: &mut Autopilot, origin: &Origin, frame: &Frame) {
    let payload = frame.payload();
    let kind = |offset: usize| match payload.u8(offset) {
        1 => MavMissionType::MAV_MISSION_TYPE_FENCE,
        2 => MavMissionType::MAV_MISSION_TYPE_RALLY,
        255 => MavMissionType::MAV_MISSION_TYPE_ALL,
        _ => MavMissionType::MAV_MISSION_TYPE_MISSION,
    };
    let ack = |result, mission_type| {
        MavMessage::MISSION_ACK(MISSION_ACK_DATA {
            target_system: origin.system,
            target_component: origin.component,
            mavtype: result,
            mission_type,
            opaque_id: 0,
        })
    };
    let message = match frame.message_id() {
        id::MISSION_REQUEST_LIST => MavMessage::MISSION_COUNT(MISSION_COUNT_DATA {
            count: 0,
            target_system: origin.system,
            target_component: origin.component,
            mission_type: kind(2),
            opaque_id: 0,
        }),
        // There is nothing that would have to be cleared.
        id::MISSION_CLEAR_ALL => ack(MavMissionResult::MAV_MISSION_ACCEPTED, kind(2)),
        _ => ack(MavMissionResult::MAV_MISSION_UNSUPPORTED, kind(4)),
    };
    autopilot.send(Destination::Peer(origin.peer), message);
}
