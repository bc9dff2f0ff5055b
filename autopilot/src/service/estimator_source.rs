//! MAV_CMD_SET_EKF_SOURCE_SET, which ArduPilot has: what the estimator fuses is one set.

use mavlink::dialects::ardupilotmega::MavCmd;
use vehicle::Refusal;

use super::{CommandEntry, Outcome, Progress, Service};
use crate::codec::Command;
use crate::context::Context;
use crate::envelope::Origin;

const COMMANDS: &[CommandEntry] = &[CommandEntry::action(MavCmd::MAV_CMD_SET_EKF_SOURCE_SET as u16)];

/// The number of the set.
const ONLY: f64 = 1.0;

/// Takes the set that is used, and no other.
#[derive(Clone, Copy, Debug)]
pub struct EstimatorSources;

impl Service for EstimatorSources {
    fn summary(&self) -> &'static str {
        "Sources of the estimator: the first set"
    }

    fn commands(&self) -> &'static [CommandEntry] {
        COMMANDS
    }

    fn command(&mut self, context: &mut Context, _origin: &Origin, command: &Command) -> Outcome {
        if !context.identity().is_ardupilot() {
            return Err(Refusal::Unsupported("Only ArduPilot has a command for source sets".to_owned()));
        }
        match command.parameter(1) {
            ONLY => Ok(Progress::Done),
            set => Err(Refusal::denied(format!("Source set {set} does not exist: only 1 (EK3_SRC1_…)"))),
        }
    }
}
