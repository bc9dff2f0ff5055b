//! Parameters of what the vehicle carries, by ArduPilot's names.

use serde::{Deserialize, Serialize};

use super::mount::MountSettings;
use super::output::{FREE_OUTPUTS, Output};
use super::parachute::ParachuteSettings;
use super::servos::FIRST_FREE_CHANNEL;

/// How what it carries is connected and set up.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct EquipmentSettings {
    /// The outputs behind those of the rotors.
    pub outputs: [Output; FREE_OUTPUTS],
    /// Channels of the radio, as bits, whose scaled outputs go to their centre when the radio is lost; others stay where they are
    /// (SERVO_RC_FS_MSK).
    pub centred_when_lost: u32,
    /// Pulses with which a servo grabs and releases, µs (GRIP_GRAB, GRIP_RELEASE).
    pub grabbing_us: u16,
    #[allow(missing_docs)] // With the one above.
    pub releasing_us: u16,
    /// Pulse before it has been told either, µs (GRIP_NEUTRAL).
    pub gripper_waits_us: u16,
    /// Time after a release after which it grabs by itself, s; 0: never (GRIP_AUTOCLOSE).
    pub gripper_closes_after_s: f64,
    /// Whether it has a landing gear (LGR_ENABLE).
    pub landing_gear: bool,
    /// The gimbal.
    pub mount: MountSettings,
    /// The parachute.
    pub parachute: ParachuteSettings,
}

/// ArduPilot's.
impl Default for EquipmentSettings {
    fn default() -> Self {
        Self {
            outputs: [Output::default(); FREE_OUTPUTS],
            centred_when_lost: 0,
            grabbing_us: 1900,
            releasing_us: 1100,
            gripper_waits_us: 1500,
            gripper_closes_after_s: 0.0,
            landing_gear: false,
            mount: MountSettings::default(),
            parachute: ParachuteSettings::default(),
        }
    }
}

impl EquipmentSettings {
    /// An output that is no rotor's, counted from 1.
    pub fn output(&self, number: usize) -> Option<&Output> {
        self.outputs.get(number.checked_sub(usize::from(FIRST_FREE_CHANNEL))?)
    }
}
