//! MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN: the vehicle boots again; the program and its links stay.

use mavlink::dialects::ardupilotmega::MavCmd;
use vehicle::{Refusal, Severity};

use super::{CommandEntry, Outcome, Progress, Service};
use crate::codec::Command;
use crate::context::Context;
use crate::envelope::Origin;

const COMMANDS: &[CommandEntry] = &[CommandEntry::action(MavCmd::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN as u16)];

/// Values of the first parameter.
const NOTHING: f64 = 0.0;
const REBOOT: f64 = 1.0;
const SHUTDOWN: f64 = 2.0;
const REBOOT_TO_BOOTLOADER: f64 = 3.0;
/// The first four parameters with which ArduPilot lets its main loop hang, to try what becomes of it.
const HANG: [f64; 4] = [42.0, 24.0, 71.0, 93.0];
/// Value of the sixth parameter with which ArduPilot reboots although it is armed.
const FORCE: f64 = 20_190_226.0;
/// The answer leaves before the vehicle is gone, µs.
const DELAY_US: u64 = 200_000;

/// Boots the vehicle again.
#[derive(Clone, Copy, Debug)]
pub struct Reboots;

impl Service for Reboots {
    fn summary(&self) -> &'static str {
        "Reboot; shutting down is refused"
    }

    fn commands(&self) -> &'static [CommandEntry] {
        COMMANDS
    }

    fn command(&mut self, context: &mut Context, _origin: &Origin, command: &Command) -> Outcome {
        let (kind, ardupilot) = (command.parameter(1), context.identity().is_ardupilot());
        if kind == NOTHING && !ardupilot {
            return Ok(Progress::Done);
        }
        if ardupilot && [1, 2, 3, 4].map(|index| command.parameter(index)) == HANG {
            context.vehicle.hang();
            return Ok(Progress::Done);
        }
        if kind == SHUTDOWN {
            return Err(Refusal::Unsupported(
                "Shutdown is not supported: stop lmpc-sitl itself, or reboot with 1".to_owned(),
            ));
        }
        if kind != REBOOT && kind != REBOOT_TO_BOOTLOADER {
            return Err(Refusal::Unsupported(format!("Reboot: action {kind} is not supported; 1 reboots")));
        }
        let vehicle = &context.vehicle;
        if vehicle.is_armed() && !(ardupilot && command.integer(6) == FORCE) {
            let reason = "Reboot rejected: disarm first".to_owned();
            return Err(if ardupilot { Refusal::Failed(reason) } else { Refusal::Denied(reason) });
        }
        if let Some(model) = vehicle.foreign() {
            let reason = format!("{} cannot start again; restart lmpc-sitl", model.name);
            return Err(Refusal::denied(format!("Reboot denied: {reason}")));
        }
        context.reboot_us.get_or_insert(vehicle.time_us() + DELAY_US);
        context.say(Severity::Info, "Rebooting");
        Ok(Progress::Done)
    }
}
