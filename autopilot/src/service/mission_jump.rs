//! Commands that go on with another part of the mission: DO_JUMP_TAG, DO_LAND_START and DO_RETURN_PATH_START.

use mavlink::dialects::ardupilotmega::MavCmd;

use vehicle::Refusal;

use super::{CommandEntry, Outcome, Progress, Service};
use crate::codec::Command;
use crate::context::Context;
use crate::envelope::Origin;

const DO_JUMP_TAG: u16 = MavCmd::MAV_CMD_DO_JUMP_TAG as u16;
const DO_LAND_START: u16 = MavCmd::MAV_CMD_DO_LAND_START as u16;

/// MAV_CMD_DO_RETURN_PATH_START, which only ArduPilot has.
const DO_RETURN_PATH_START: u16 = vehicle::plan::command::DO_RETURN_PATH_START;

/// Goes on elsewhere.
#[derive(Clone, Copy, Debug)]
pub struct MissionJumps;

impl Service for MissionJumps {
    fn summary(&self) -> &'static str {
        "Jumps within a mission"
    }

    fn commands(&self) -> &'static [CommandEntry] {
        const COMMANDS: &[CommandEntry] = &[
            CommandEntry::action(DO_JUMP_TAG),
            CommandEntry::action(DO_LAND_START),
            CommandEntry::action(DO_RETURN_PATH_START),
        ];
        COMMANDS
    }

    fn command(&mut self, context: &mut Context, _origin: &Origin, command: &Command) -> Outcome {
        match command.number {
            DO_JUMP_TAG => context.vehicle.jump_to_tag(command.parameter(1))?,
            DO_RETURN_PATH_START if context.vehicle.identity().is_ardupilot() => {
                context.vehicle.start_return_path()?;
            }
            DO_RETURN_PATH_START => {
                return Err(Refusal::Unsupported("DO_RETURN_PATH_START: not a command of PX4".to_owned()));
            }
            _ => context.vehicle.start_landing()?,
        }
        Ok(Progress::Done)
    }
}
