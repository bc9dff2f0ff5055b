//! MAV_CMD_SET_EKF_SOURCE_SET, which ArduPilot has: what the estimator fuses is one of three sets.

use mavlink::dialects::ardupilotmega::MavCmd;
use vehicle::Refusal;

use super::{CommandEntry, Outcome, Progress, Service};
use crate::codec::Command;
use crate::context::Context;
use crate::envelope::Origin;

const COMMANDS: &[CommandEntry] = &[CommandEntry::action(MavCmd::MAV_CMD_SET_EKF_SOURCE_SET as u16)];

/// Numbers of the sets.
const SETS: [f64; 3] = [1.0, 2.0, 3.0];

/// Lets the estimator use a set.
#[derive(Clone, Copy, Debug)]
pub struct EstimatorSources;

impl Service for EstimatorSources {
    fn summary(&self) -> &'static str {
        "Sources of the estimator: one of three sets"
    }

    fn commands(&self) -> &'static [CommandEntry] {
        COMMANDS
    }

    fn command(&mut self, context: &mut Context, _origin: &Origin, command: &Command) -> Outcome {
        if !context.identity().is_ardupilot() {
            return Err(Refusal::Unsupported("Only ArduPilot has a command for source sets".to_owned()));
        }
        let number = command.parameter(1);
        let Some(set) = SETS.iter().position(|known| *known == number) else {
            return Err(Refusal::denied(format!(
                "Source set {number} does not exist: 1, 2 or 3 (EK3_SRC1_…)"
            )));
        };
        context.vehicle.use_source_set(set);
        Ok(Progress::Done)
    }
}
