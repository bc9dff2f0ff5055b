//! `--equipment`: who speaks for camera and gimbal.

use clap::ValueEnum;
use vehicle::equipment::EquipmentVoice;

/// The values of the flag.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, ValueEnum)]
pub enum EquipmentChoice {
    /// The autopilot speaks for camera and gimbal; no other component sends heartbeats
    #[default]
    Autopilot,
    /// Camera (component 100) and gimbal (154) send heartbeats of their own
    Own,
}

impl From<EquipmentChoice> for EquipmentVoice {
    fn from(choice: EquipmentChoice) -> Self {
        match choice {
            EquipmentChoice::Autopilot => Self::Autopilot,
            EquipmentChoice::Own => Self::Own,
        }
    }
}
