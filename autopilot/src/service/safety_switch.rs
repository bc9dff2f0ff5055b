//! MAV_CMD_DO_SET_SAFETY_SWITCH_STATE, which ArduPilot has.

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

/// Switches the safety switch.
#[derive(Clone, Copy, Debug)]
pub struct SafetySwitch;

impl Service for SafetySwitch {
    fn summary(&self) -> &'static str {
        "Safety switch"
    }

    fn commands(&self) -> &'static [CommandEntry] {
        COMMANDS
    }

    fn command(&mut self, context: &mut Context, _origin: &Origin, command: &Command) -> Outcome {
        if !context.identity().is_ardupilot() {
            return Err(Refusal::Unsupported("Only ArduPilot has a command for a safety switch".to_owned()));
        }
        let state = command.parameter(1);
        if state != SAFE && state != DANGEROUS {
            let text = format!("Safety switch denied: state {state}; allowed 0 (safe), 1 (rotors may turn)");
            return Err(Refusal::denied(text));
        }
        context.vehicle.switch_safety(state == SAFE)?;
        Ok(Progress::Done)
    }
}
