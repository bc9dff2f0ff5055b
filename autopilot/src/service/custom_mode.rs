//! Modes by their numbers in HEARTBEAT: SET_MODE, and the commands that replaced it.

use mavlink::dialects::ardupilotmega::MavCmd;
use vehicle::{Mode, Refusal, Vehicle};

use super::command::{acknowledge_outcome, as_told_by, explain};
use super::{CommandEntry, Outcome, Progress, Service};
use crate::codec::{Command, Frame, id};
use crate::context::Context;
use crate::envelope::Origin;

const NAV_GUIDED_ENABLE: u16 = MavCmd::MAV_CMD_NAV_GUIDED_ENABLE as u16;
const DO_SET_MODE: u16 = MavCmd::MAV_CMD_DO_SET_MODE as u16;

/// MAV_MODE_FLAG_DECODE_POSITION_SAFETY, alone.
const SAFETY: u8 = 128;

/// Changes modes.
#[derive(Clone, Copy, Debug)]
pub struct CustomModes;

impl Service for CustomModes {
    fn summary(&self) -> &'static str {
        "Modes by their numbers in HEARTBEAT"
    }

    fn messages(&self) -> &'static [u32] {
        &[id::SET_MODE]
    }

    fn commands(&self) -> &'static [CommandEntry] {
        const COMMANDS: &[CommandEntry] =
            &[CommandEntry::action(NAV_GUIDED_ENABLE), CommandEntry::action(DO_SET_MODE)];
        COMMANDS
    }

    /// SET_MODE: answered as the command that replaced it, as PX4 and ArduPilot do. With the base mode for it, its number is the state
    /// of ArduPilot's safety switch.
    fn receive(&mut self, context: &mut Context, origin: &Origin, frame: &Frame) {
        const SET_MODE_MESSAGE: u16 = id::SET_MODE as u16;
        let (number, base_mode) = (frame.payload().u32(0), frame.payload().u8(5));
        let result = if context.identity().is_ardupilot() && base_mode == SAFETY {
            switch_safety(&mut context.vehicle, number)
        } else {
            change_to(&mut context.vehicle, number)
        };
        let outcome = result.map(|()| Progress::Done);
        acknowledge_outcome(&mut context.outbox, origin, SET_MODE_MESSAGE, Some(&outcome));
        explain(context, &outcome);
    }

    fn command(&mut self, context: &mut Context, _origin: &Origin, command: &Command) -> Outcome {
        let vehicle = &mut context.vehicle;
        match command.number {
            // It has it in missions only, and scripts that send it without parameters expect to stay in Guided.
            NAV_GUIDED_ENABLE if vehicle.identity().is_ardupilot() => {
                let reason = "NAV_GUIDED_ENABLE is not supported as a command: switch to Guided mode";
                return Err(Refusal::Unsupported(reason.to_owned()));
            }
            NAV_GUIDED_ENABLE if command.parameter(1) > 0.5 => vehicle.set_mode(Mode::Offboard)?,
            NAV_GUIDED_ENABLE => vehicle.set_mode(Mode::Hold)?,
            _ => set_mode(vehicle, command)?,
        }
        Ok(Progress::Done)
    }
}

fn switch_safety(vehicle: &mut Vehicle, state: u32) -> Result<(), Refusal> {
    match state {
        0 | 1 => vehicle.switch_safety(state == 1),
        _ => {
            let text =
                format!("Safety switch rejected: state {state}; allowed 0 (rotors may turn), 1 (safe)");
            Err(Refusal::Failed(text))
        }
    }
}

/// ArduPilot answers a mode that it does not change to by a failure, whatever the reason is.
fn change_to(vehicle: &mut Vehicle, custom_mode: u32) -> Result<(), Refusal> {
    let identity = vehicle.identity();
    vehicle.set_custom_mode(custom_mode).map_err(|refusal| match refusal {
        Refusal::Unsupported(reason) if identity.is_ardupilot() => Refusal::Failed(reason),
        refusal => as_told_by(identity, refusal),
    })
}

fn set_mode(vehicle: &mut Vehicle, command: &Command) -> Result<(), Refusal> {
    const CUSTOM_MODE_ENABLED: u32 = 1;
    let (base, main, sub) = (command.whole(1), command.whole(2), command.whole(3).unwrap_or(0));
    let (Some(base), Some(main)) = (base, main) else {
        return Err(Refusal::denied("DO_SET_MODE requires a mode"));
    };
    if base & CUSTOM_MODE_ENABLED == 0 {
        return Err(Refusal::Unsupported("Only custom modes are supported".to_owned()));
    }
    let custom_mode = if vehicle.identity().is_ardupilot() {
        main
    } else if main <= 0xff && sub <= 0xff {
        main << 16 | sub << 24
    } else {
        return Err(Refusal::denied(format!("Unknown mode {main}, {sub}")));
    };
    change_to(vehicle, custom_mode)
}
