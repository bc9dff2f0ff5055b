//! HEARTBEAT: once a second, and at once when mode or arming change.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::{
    HEARTBEAT_DATA, MavAutopilot, MavMessage, MavModeFlag, MavState, MavType,
};
use vehicle::identity::Identity;
use vehicle::{Action, Cause, Leader, Mode, SteeringKind, Vehicle};

use super::Service;
use crate::context::Context;
use crate::envelope::Destination;
use crate::stream::{Build, Stream};

const PERIOD_US: u64 = 1_000_000;

const STREAMS: &[Stream] = &[Stream::on_request(HEARTBEAT_DATA::ID, Build::Vehicle(message))];

/// What was told last, and when to tell again.
#[derive(Clone, Copy, Debug, Default)]
pub struct Heartbeat {
    told: Option<(bool, Mode, bool, MavState)>,
    due_us: u64,
}

impl Service for Heartbeat {
    fn summary(&self) -> &'static str {
        "Who it is, its mode and whether it is armed"
    }

    fn streams(&self) -> &'static [Stream] {
        STREAMS
    }

    fn start(&mut self, context: &mut Context) {
        self.announce(context);
    }

    fn announce(&mut self, context: &mut Context) {
        let vehicle = &context.vehicle;
        let idle = vehicle.steering_kind() == SteeringKind::Idle;
        let now = (vehicle.is_armed(), vehicle.mode(), idle, system_status(vehicle));
        let time_us = vehicle.time_us();
        if self.told == Some(now) && time_us < self.due_us {
            return;
        }
        *self = Self { told: Some(now), due_us: time_us + PERIOD_US };
        context.outbox.send(Destination::Everyone, message(vehicle));
    }
}

/// The heartbeat of now.
pub fn message(vehicle: &Vehicle) -> MavMessage {
    MavMessage::HEARTBEAT(data(vehicle))
}

/// The heartbeat of a vehicle that will send no other.
pub fn last_message(vehicle: &Vehicle) -> MavMessage {
    MavMessage::HEARTBEAT(HEARTBEAT_DATA {
        system_status: MavState::MAV_STATE_FLIGHT_TERMINATION,
        ..data(vehicle)
    })
}

/// Its fields: other messages have some of them, too.
pub fn data(vehicle: &Vehicle) -> HEARTBEAT_DATA {
    HEARTBEAT_DATA {
        custom_mode: vehicle.identity().custom_mode(vehicle.shown_mode()),
        mavtype: MavType::MAV_TYPE_QUADROTOR,
        autopilot: match vehicle.identity() {
            Identity::Px4 => MavAutopilot::MAV_AUTOPILOT_PX4,
            Identity::ArduPilot => MavAutopilot::MAV_AUTOPILOT_ARDUPILOTMEGA,
            Identity::Generic => MavAutopilot::MAV_AUTOPILOT_GENERIC,
        },
        base_mode: base_mode(vehicle),
        system_status: system_status(vehicle),
        mavlink_version: 3,
    }
}

fn system_status(vehicle: &Vehicle) -> MavState {
    if vehicle.is_terminated() {
        return MavState::MAV_STATE_FLIGHT_TERMINATION;
    }
    if !vehicle.is_armed() {
        return MavState::MAV_STATE_STANDBY;
    }
    let failsafe = vehicle.failsafe();
    let acts = |cause: &Cause| vehicle.conduct().failsafe.action(*cause) > Action::Warn;
    if failsafe.present().filter(acts).any(Cause::is_emergency) {
        MavState::MAV_STATE_EMERGENCY
    } else if failsafe.engaged().is_some() {
        MavState::MAV_STATE_CRITICAL
    } else {
        MavState::MAV_STATE_ACTIVE
    }
}

fn base_mode(vehicle: &Vehicle) -> MavModeFlag {
    let stabilized =
        MavModeFlag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED | MavModeFlag::MAV_MODE_FLAG_STABILIZE_ENABLED;
    let guided = stabilized | MavModeFlag::MAV_MODE_FLAG_GUIDED_ENABLED;
    let flags = match vehicle.mode().leader() {
        Leader::Sticks => stabilized | MavModeFlag::MAV_MODE_FLAG_MANUAL_INPUT_ENABLED,
        Leader::SetPoints => guided,
        Leader::Vehicle => guided | MavModeFlag::MAV_MODE_FLAG_AUTO_ENABLED,
    };
    if vehicle.is_armed() { flags | MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED } else { flags }
}
