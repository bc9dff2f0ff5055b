//! Starting a mission, its current item, and how far it has come.

use mavlink::dialects::ardupilotmega::{
    MISSION_CURRENT_DATA, MISSION_ITEM_REACHED_DATA, MavMessage, MissionState as MavMissionState,
};
use vehicle::plan::PlanKind;
use vehicle::{MissionState, MissionStatus, Refusal, Severity, Vehicle};

use crate::codec::{Command, Frame};
use crate::context::Context;
use crate::envelope::Destination;

/// What was told of the mission last.
#[derive(Clone, Copy, Debug, Default)]
pub struct MissionProgress {
    told: Option<MissionStatus>,
}

impl MissionProgress {
    /// MAV_CMD_DO_SET_MISSION_CURRENT: item (−1: the present one), and whether the mission begins anew.
    pub fn set_current_by_command(
        &mut self,
        context: &mut Context,
        command: &Command,
    ) -> Result<(), Refusal> {
        let reset = command.parameter(2) == 1.0;
        let index = if command.parameter(1) == -1.0 {
            context.vehicle.mission_status().current
        } else {
            command.whole(1).ok_or_else(|| Refusal::denied("Mission item number required"))? as usize
        };
        context.vehicle.set_mission_item(index, reset)?;
        self.tell(context);
        Ok(())
    }

    /// MISSION_SET_CURRENT: answered to everyone, by the new item or by why there is none.
    pub fn set_current(&mut self, context: &mut Context, frame: &Frame) {
        match context.vehicle.set_mission_item(usize::from(frame.payload().u16(0)), false) {
            Ok(()) => self.tell(context),
            Err(refusal) => context.say(Severity::Error, &refusal.to_string()),
        }
    }

    /// Tells at once what was reached, and what has changed.
    pub fn update(&mut self, context: &mut Context) {
        for seq in context.vehicle.take_reached_items() {
            let message = MavMessage::MISSION_ITEM_REACHED(MISSION_ITEM_REACHED_DATA { seq });
            context.outbox.send(Destination::Everyone, message);
        }
        if self.told != Some(context.vehicle.mission_status()) {
            self.tell(context);
        }
    }

    fn tell(&mut self, context: &mut Context) {
        self.told = Some(context.vehicle.mission_status());
        context.outbox.send(Destination::Everyone, current(&context.vehicle));
    }
}

/// MAV_CMD_MISSION_START: first item; zero or less begins where the mission is. PX4 arms for it. ArduPilot begins where the mission is
/// and takes no other item; disarmed it only changes its mode, and flies when it is armed.
pub fn start(context: &mut Context, command: &Command) -> Result<(), Refusal> {
    let first = command.whole(1).filter(|first| *first > 0).map(|first| first as usize);
    let vehicle = &mut context.vehicle;
    if vehicle.identity().is_ardupilot() {
        if command.parameter(1) != 0.0 || command.parameter(2) != 0.0 {
            return Err(Refusal::denied(
                "Mission denied: first and last item must be 0; use DO_SET_MISSION_CURRENT",
            ));
        }
        return vehicle.start_mission(None).map_err(|refusal| Refusal::Failed(refusal.to_string()));
    }
    vehicle.start_mission(first)?;
    vehicle.arm(false)
}

/// MISSION_CURRENT.
pub fn current(vehicle: &Vehicle) -> MavMessage {
    let MissionStatus { current, total, state, in_mode } = vehicle.mission_status();
    let id = |kind| vehicle.plans().get(kind).id();
    let number = |value: usize| u16::try_from(value).unwrap_or(u16::MAX);
    MavMessage::MISSION_CURRENT(MISSION_CURRENT_DATA {
        seq: number(current),
        total: if state == MissionState::None { u16::MAX } else { number(total) },
        mission_state: match state {
            MissionState::None => MavMissionState::MISSION_STATE_NO_MISSION,
            MissionState::NotStarted => MavMissionState::MISSION_STATE_NOT_STARTED,
            MissionState::Active => MavMissionState::MISSION_STATE_ACTIVE,
            MissionState::Paused => MavMissionState::MISSION_STATE_PAUSED,
            MissionState::Complete => MavMissionState::MISSION_STATE_COMPLETE,
        },
        mission_mode: if in_mode { 1 } else { 2 },
        mission_id: id(PlanKind::Mission),
        fence_id: id(PlanKind::Fence),
        rally_points_id: id(PlanKind::Rally),
    })
}
