//! Heartbeats of camera and gimbal, where they are components of their own.

use mavlink::dialects::ardupilotmega::{
    HEARTBEAT_DATA, MavAutopilot, MavMessage, MavModeFlag, MavState, MavType,
};
use vehicle::equipment::EquipmentVoice;

use crate::context::Context;
use crate::envelope::Destination;
use crate::service::Service;
use crate::speaker::Speaker;

const PERIOD_US: u64 = 1_000_000;

/// When the next ones are due, µs.
#[derive(Clone, Copy, Debug, Default)]
pub struct EquipmentHeartbeats {
    due_us: u64,
}

impl Service for EquipmentHeartbeats {
    fn summary(&self) -> &'static str {
        "Camera and gimbal as components of their own"
    }

    fn announce(&mut self, context: &mut Context) {
        let time_us = context.vehicle.time_us();
        if context.outbox.voice() != EquipmentVoice::Own || time_us < self.due_us {
            return;
        }
        self.due_us = time_us + PERIOD_US;
        let kinds =
            [(Speaker::Camera, MavType::MAV_TYPE_CAMERA), (Speaker::Gimbal, MavType::MAV_TYPE_GIMBAL)];
        for (speaker, kind) in kinds {
            context.outbox.send_as(speaker, Destination::Everyone, message(kind));
        }
    }
}

fn message(kind: MavType) -> MavMessage {
    MavMessage::HEARTBEAT(HEARTBEAT_DATA {
        custom_mode: 0,
        mavtype: kind,
        autopilot: MavAutopilot::MAV_AUTOPILOT_INVALID,
        base_mode: MavModeFlag::empty(),
        system_status: MavState::MAV_STATE_ACTIVE,
        mavlink_version: 3,
    })
}
