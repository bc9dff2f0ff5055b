//! How the gimbal is mounted and pointed, by ArduPilot's names (MNT1_…).

use serde::{Deserialize, Serialize};

use super::gimbal::GimbalLimits;

/// Who points the gimbal, or at what.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum GimbalMode {
    /// Nobody: it is folded away.
    Retracted,
    /// Nobody: it looks ahead.
    Neutral,
    /// Commands.
    Commands,
    /// The pilot's channels.
    Radio,
    /// It looks at what the vehicle looks at.
    Region,
    /// It looks at home.
    Home,
}

/// The settings of the gimbal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct MountSettings {
    /// ArduPilot's number of its kind; 0: ours, which only commands point, and which has ranges of its own.
    pub kind: u8,
    /// Its mode at the start, and when nothing is looked at any more.
    pub first_mode: GimbalMode,
    /// Rate of a full deflection of the pilot's channel, rad/s; 0: the deflection is an angle.
    pub radio_rate_rad_s: f64,
    /// Least and largest roll, pitch, and yaw from the nose, rad.
    pub roll_rad: [f64; 2],
    #[allow(missing_docs)] // With the one above.
    pub pitch_rad: [f64; 2],
    #[allow(missing_docs)] // With the one above.
    pub yaw_rad: [f64; 2],
    /// Roll, pitch and yaw where it looks ahead, and where it is folded away, rad.
    pub neutral_rad: [f64; 3],
    #[allow(missing_docs)] // With the one above.
    pub folded_rad: [f64; 3],
}

/// Servos come to their angles at once, rad/s.
const SERVO_RAD_S: f64 = 1000.0 * core::f64::consts::TAU;
/// The number of a mount of servos.
const SERVOS: u8 = 1;

/// ArduPilot's, without a mount.
impl Default for MountSettings {
    fn default() -> Self {
        Self {
            kind: 0,
            first_mode: GimbalMode::Radio,
            radio_rate_rad_s: 0.0,
            roll_rad: [-30.0, 30.0].map(f64::to_radians),
            pitch_rad: [-90.0, 20.0].map(f64::to_radians),
            yaw_rad: [-180.0, 180.0].map(f64::to_radians),
            neutral_rad: [0.0; 3],
            folded_rad: [0.0; 3],
        }
    }
}

impl MountSettings {
    /// Whether it is mounted as these settings say.
    pub fn is_set_up(&self) -> bool {
        self.kind > 0
    }

    /// What it reaches, and how fast it turns. Ends are set one at a time: crossed ones are the range between them.
    pub fn limits(&self) -> GimbalLimits {
        let ours = GimbalLimits::OURS;
        if !self.is_set_up() {
            return ours;
        }
        let rate_rad_s = if self.kind == SERVOS { SERVO_RAD_S } else { ours.rate_rad_s };
        let ordered = |[one, other]: [f64; 2]| [one.min(other), one.max(other)];
        GimbalLimits {
            roll_rad: ordered(self.roll_rad),
            pitch_rad: ordered(self.pitch_rad),
            yaw_rad: ordered(self.yaw_rad),
            rate_rad_s,
        }
    }

    /// Its mode when nothing is looked at.
    pub fn resting_mode(&self) -> GimbalMode {
        if self.is_set_up() { self.first_mode } else { GimbalMode::Neutral }
    }
}
