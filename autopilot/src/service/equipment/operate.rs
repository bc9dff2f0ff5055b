//! A command for the equipment is the same as an item of a mission.

use vehicle::plan::step::Do;
use vehicle::plan::{FaultCode, MissionItem, compile};
use vehicle::{Refusal, Vehicle};

use crate::codec::{Command, command_name};
use crate::service::command::told_frame;

/// Has a command carried out by the equipment.
///
/// # Errors
/// [`Refusal`] of parameters, and as [`Vehicle::operate`].
pub fn operate(vehicle: &mut Vehicle, command: &Command) -> Result<(), Refusal> {
    let item = MissionItem {
        frame: told_frame(command),
        command: command.number,
        parameters: command.parameters,
        position: [command.x, command.y, command.z],
        autocontinue: true,
    };
    let name = || command_name(command.number);
    let action = compile::action(&item, &vehicle.site()).map_err(|fault| match fault.code {
        FaultCode::Unsupported => Refusal::Unsupported(format!("{}: {}", name(), fault.reason)),
        _ => Refusal::denied(format!("{}: {}", name(), fault.reason)),
    })?;
    match action {
        Do::Operate(operation) => vehicle.operate(&operation),
        Do::Absent(what) => Err(Refusal::Unsupported(format!("{}: no {what}", name()))),
        _ => Ok(()),
    }
}
