//! Standard modes: AVAILABLE_MODES, CURRENT_MODE and DO_SET_STANDARD_MODE.

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega::{
    AVAILABLE_MODES_DATA, CURRENT_MODE_DATA, MavCmd, MavMessage, MavModeProperty, MavStandardMode,
};
use vehicle::identity::Identity;
use vehicle::{Leader, Mode, Refusal, Vehicle};

use super::{CommandEntry, Outcome, Progress, Service};
use crate::codec::Command;
use crate::context::Context;
use crate::envelope::Origin;
use crate::stream::{Build, Stream};

const COMMANDS: &[CommandEntry] = &[CommandEntry::action(MavCmd::MAV_CMD_DO_SET_STANDARD_MODE as u16)];

const STREAMS: &[Stream] = &[
    Stream::on_request(AVAILABLE_MODES_DATA::ID, Build::Numbered(available)),
    Stream::on_request(CURRENT_MODE_DATA::ID, Build::Vehicle(current)),
];

/// Lists modes and changes them.
#[derive(Clone, Copy, Debug)]
pub struct StandardModes;

impl Service for StandardModes {
    fn summary(&self) -> &'static str {
        "Standard modes"
    }

    fn commands(&self) -> &'static [CommandEntry] {
        COMMANDS
    }

    fn streams(&self) -> &'static [Stream] {
        STREAMS
    }

    fn command(&mut self, context: &mut Context, _origin: &Origin, command: &Command) -> Outcome {
        let identity = context.identity();
        let mode = command.whole(1).and_then(|number| mode(identity, number));
        let mode =
            mode.ok_or_else(|| Refusal::denied(format!("Unknown standard mode {}", command.parameter(1))))?;
        context.vehicle.set_mode(mode)?;
        Ok(Progress::Done)
    }
}

/// The standard mode that a mode is.
fn standard(mode: Mode) -> MavStandardMode {
    match mode {
        Mode::Position => MavStandardMode::MAV_STANDARD_MODE_POSITION_HOLD,
        Mode::Altitude => MavStandardMode::MAV_STANDARD_MODE_ALTITUDE_HOLD,
        Mode::Return => MavStandardMode::MAV_STANDARD_MODE_SAFE_RECOVERY,
        Mode::Land => MavStandardMode::MAV_STANDARD_MODE_LAND,
        Mode::Mission => MavStandardMode::MAV_STANDARD_MODE_MISSION,
        Mode::Takeoff => MavStandardMode::MAV_STANDARD_MODE_TAKEOFF,
        Mode::Orbit => MavStandardMode::MAV_STANDARD_MODE_ORBIT,
        _ => MavStandardMode::MAV_STANDARD_MODE_NON_STANDARD,
    }
}

/// The mode of a standard mode's number, if there is one.
fn mode(identity: Identity, number: u32) -> Option<Mode> {
    let non_standard = MavStandardMode::MAV_STANDARD_MODE_NON_STANDARD as u32;
    let mut modes = identity.selectable_modes().filter(|_| number != non_standard);
    modes.find(|mode| standard(*mode) as u32 == number)
}

/// AVAILABLE_MODES of one mode, counted from one, or of all for zero; empty for any other number.
fn available(vehicle: &Vehicle, index: u32) -> Vec<MavMessage> {
    let identity = vehicle.identity();
    let modes: Vec<Mode> = identity.selectable_modes().collect();
    let wanted = |number: u32| index == 0 || index == number;
    (1..)
        .zip(&modes)
        .filter(|(number, _)| wanted(*number))
        .map(|(number, mode)| {
            let automatic = mode.leader() != Leader::Sticks;
            MavMessage::AVAILABLE_MODES(AVAILABLE_MODES_DATA {
                custom_mode: identity.custom_mode(*mode),
                properties: if automatic {
                    MavModeProperty::MAV_MODE_PROPERTY_AUTO_MODE
                } else {
                    MavModeProperty::empty()
                },
                number_modes: modes.len() as u8,
                mode_index: number as u8,
                standard_mode: standard(*mode),
                mode_name: identity.mode_name(*mode).into(),
            })
        })
        .collect()
}

/// CURRENT_MODE.
fn current(vehicle: &Vehicle) -> MavMessage {
    let custom_mode = vehicle.identity().custom_mode(vehicle.shown_mode());
    MavMessage::CURRENT_MODE(CURRENT_MODE_DATA {
        standard_mode: standard(vehicle.mode()),
        custom_mode,
        intended_custom_mode: custom_mode,
    })
}
