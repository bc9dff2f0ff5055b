//! MISSION_ACK, and lines for the pilot.

use mavlink::dialects::ardupilotmega::{MISSION_ACK_DATA, MavMessage, MavMissionResult, MavMissionType};
use vehicle::plan::{FaultCode, PlanFault, PlanKind};

use crate::context::Context;
use crate::envelope::{Destination, Origin};

/// MAV_MISSION_TYPE; what is none is answered as all of them.
pub fn kind_of(number: u8) -> MavMissionType {
    match number {
        0 => MavMissionType::MAV_MISSION_TYPE_MISSION,
        1 => MavMissionType::MAV_MISSION_TYPE_FENCE,
        2 => MavMissionType::MAV_MISSION_TYPE_RALLY,
        _ => MavMissionType::MAV_MISSION_TYPE_ALL,
    }
}

fn result_of(code: FaultCode) -> MavMissionResult {
    match code {
        FaultCode::Error => MavMissionResult::MAV_MISSION_ERROR,
        FaultCode::UnsupportedFrame => MavMissionResult::MAV_MISSION_UNSUPPORTED_FRAME,
        FaultCode::Unsupported => MavMissionResult::MAV_MISSION_UNSUPPORTED,
        FaultCode::NoSpace => MavMissionResult::MAV_MISSION_NO_SPACE,
        FaultCode::Invalid => MavMissionResult::MAV_MISSION_INVALID,
        FaultCode::InvalidParameter(1) => MavMissionResult::MAV_MISSION_INVALID_PARAM1,
        FaultCode::InvalidParameter(2) => MavMissionResult::MAV_MISSION_INVALID_PARAM2,
        FaultCode::InvalidParameter(3) => MavMissionResult::MAV_MISSION_INVALID_PARAM3,
        FaultCode::InvalidParameter(4) => MavMissionResult::MAV_MISSION_INVALID_PARAM4,
        FaultCode::InvalidParameter(5) => MavMissionResult::MAV_MISSION_INVALID_PARAM5_X,
        FaultCode::InvalidParameter(6) => MavMissionResult::MAV_MISSION_INVALID_PARAM6_Y,
        FaultCode::InvalidParameter(_) => MavMissionResult::MAV_MISSION_INVALID_PARAM7,
        FaultCode::InvalidSequence => MavMissionResult::MAV_MISSION_INVALID_SEQUENCE,
        FaultCode::Denied => MavMissionResult::MAV_MISSION_DENIED,
        FaultCode::Cancelled => MavMissionResult::MAV_MISSION_OPERATION_CANCELLED,
    }
}

fn send(context: &mut Context, origin: &Origin, mission_type: u8, mavtype: MavMissionResult, id: u32) {
    let message = MavMessage::MISSION_ACK(MISSION_ACK_DATA {
        target_system: origin.system,
        target_component: origin.component,
        mavtype,
        mission_type: kind_of(mission_type),
        opaque_id: id,
    });
    context.outbox.send(Destination::Peer(origin.peer), message);
}

/// It is done; `id` is that of the plan that there is now.
pub fn accepted(context: &mut Context, origin: &Origin, mission_type: u8, id: u32) {
    send(context, origin, mission_type, MavMissionResult::MAV_MISSION_ACCEPTED, id);
}

/// It is refused, without a line for the pilot.
pub fn refused(context: &mut Context, origin: &Origin, mission_type: u8, code: FaultCode) {
    send(context, origin, mission_type, result_of(code), 0);
}

/// It is refused, and the pilot is told why.
pub fn refused_aloud(context: &mut Context, origin: &Origin, mission_type: u8, fault: &PlanFault) {
    refused(context, origin, mission_type, fault.code);
    let name = PlanKind::of(mission_type).map_or("Plan", PlanKind::name);
    context.reject_plan(name, fault);
}

#[cfg(test)]
mod tests {
    use super::{FaultCode, result_of};

    /// The numbers are the dialect's.
    #[test]
    fn every_fault_has_its_number() {
        let parameters = (1..=7).map(FaultCode::InvalidParameter);
        let others = [
            FaultCode::Error,
            FaultCode::UnsupportedFrame,
            FaultCode::Unsupported,
            FaultCode::NoSpace,
            FaultCode::Invalid,
            FaultCode::InvalidSequence,
            FaultCode::Denied,
            FaultCode::Cancelled,
        ];
        for code in parameters.chain(others) {
            assert_eq!(result_of(code) as u32, u32::from(code.number()), "{code:?}");
        }
    }
}
