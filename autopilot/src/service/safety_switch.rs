//! MAV_CMD_DO_SET_SAFETY_SWITCH_STATE, which ArduPilot has: this vehicle has no switch, and its rotors are always free to turn.

use mavlink::dialects::ardupilotmega::MavCmd;
use vehicle::Refusal;

use super::{CommandEntry, Outcome, Progress, Service};
use crate::codec::Command;
use crate::context::Context;
use crate::envelope::Origin;

const COMMANDS: &[CommandEntry] = &[CommandEntry::action(MavCmd::MAV_CMD_DO_SET_SAFETY_SWITCH_STATE as u16)];

/// Values of the first parameter.
const SAFE: f64 = 0.0;
const DANGEROUS: f64 = 1.0;

/// Answers as a board without the switch.
#[derive(Clone, Copy, Debug)]
pub struct SafetySwitch;

impl Service for SafetySwitch {
    fn summary(&self) -> &'static str {
        "Safety switch; there is none, so it is always off"
    }

    fn commands(&self) -> &'static [CommandEntry] {
        COMMANDS
    }

    fn command(&mut self, context: &mut Context, _origin: &Origin, command: &Command) -> Outcome {
        if !context.identity().is_ardupilot() {
            return Err(Refusal::Unsupported("Only ArduPilot has a command for a safety switch".to_owned()));
        }
        match command.parameter(1) {
            DANGEROUS => Ok(Progress::Done),
            SAFE => {
                Err(Refusal::Failed("There is no safety switch: disarm to keep the rotors still".to_owned()))
            }
            state => Err(Refusal::denied(format!("Safety switch: state {state} is neither 0 (safe) nor 1"))),
        }
    }
}
