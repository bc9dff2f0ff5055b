//! Servos, relays, gripper, landing gear and parachute.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::{MavCmd, MavMessage, RELAY_STATUS_DATA};
use vehicle::Vehicle;
use vehicle::equipment::Relays;

use super::operate::operate;
use crate::codec::{Command, boot_ms};
use crate::context::Context;
use crate::envelope::Origin;
use crate::service::{CommandEntry, Outcome, Progress, Service};
use crate::stream::Stream;

const COMMANDS: &[CommandEntry] = &[
    CommandEntry::action(MavCmd::MAV_CMD_DO_SET_SERVO as u16),
    CommandEntry::action(MavCmd::MAV_CMD_DO_REPEAT_SERVO as u16),
    CommandEntry::action(MavCmd::MAV_CMD_DO_SET_ACTUATOR as u16),
    CommandEntry::action(MavCmd::MAV_CMD_DO_SET_RELAY as u16),
    CommandEntry::action(MavCmd::MAV_CMD_DO_REPEAT_RELAY as u16),
    CommandEntry::action(MavCmd::MAV_CMD_DO_GRIPPER as u16),
    CommandEntry::action(MavCmd::MAV_CMD_DO_PARACHUTE as u16),
    CommandEntry::action(MavCmd::MAV_CMD_AIRFRAME_CONFIGURATION as u16),
];

const STREAMS: &[Stream] = &[Stream::new(RELAY_STATUS_DATA::ID, [0.0, 0.0], relay_status)];

/// Moves and switches them.
#[derive(Clone, Copy, Debug)]
pub struct Outputs;

impl Service for Outputs {
    fn summary(&self) -> &'static str {
        "Servos, relays, a gripper, a landing gear and a parachute"
    }

    fn commands(&self) -> &'static [CommandEntry] {
        COMMANDS
    }

    fn streams(&self) -> &'static [Stream] {
        STREAMS
    }

    fn command(&mut self, context: &mut Context, _origin: &Origin, command: &Command) -> Outcome {
        operate(&mut context.vehicle, command)?;
        Ok(Progress::Done)
    }
}

/// RELAY_STATUS.
fn relay_status(vehicle: &Vehicle) -> MavMessage {
    MavMessage::RELAY_STATUS(RELAY_STATUS_DATA {
        time_boot_ms: boot_ms(vehicle.time_us()),
        on: vehicle.equipment().relays().on(),
        present: Relays::present(),
    })
}
