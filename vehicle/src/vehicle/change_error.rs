//! Why parameters of the closed loop do not change.

use quadrotor::ConfigurationError;

use crate::foreign::ForeignRole;

/// Why the parameters of the closed loop do not change. Nothing has changed then.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ChangeError {
    /// The values.
    #[error(transparent)]
    Configuration(#[from] ConfigurationError),
    /// They describe what flies in place of ours.
    #[error(
        "{model} flies as the {role}: parameters of the {part} cannot change in flight; set them at the start"
    )]
    Foreign {
        /// What flies.
        model: String,
        /// In place of what.
        role: ForeignRole,
        /// What the parameters describe.
        part: &'static str,
    },
    /// Ideal sensors have no readings that could be wrong.
    #[error("ideal sensors have no errors; start with --sensors realistic")]
    IdealSensors,
    /// With ideal sensors the vehicle knows its place.
    #[error("ideal sensors need no fixes by GPS_INPUT; start with --sensors realistic")]
    IdealReceiver,
    /// The battery is part of the plant, which does not jump.
    #[error("the rotors follow the battery's voltage (FRAME_BATT_SAG): its charge cannot be set in flight")]
    BatteryOfPlant,
}
