//! What the vehicle presents itself as: it decides what clients show and how they encode.

use serde::{Deserialize, Serialize};

/// Conventions that clients know a vehicle by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Identity {
    /// PX4's autopilot id, modes, parameter encoding (bytewise), and takeoff altitude above sea level.
    #[default]
    Px4,
    /// ArduPilot's autopilot id, copter modes, parameter encoding (cast), and takeoff altitude above home.
    ArduPilot,
    /// No autopilot's id; the rest as PX4. QGroundControl offers no guided action then.
    Generic,
}

impl Identity {
    /// What people call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Px4 => "PX4",
            Self::ArduPilot => "ArduPilot",
            Self::Generic => "generic",
        }
    }

    /// MAV_AUTOPILOT.
    pub fn autopilot(self) -> u8 {
        match self {
            Self::Px4 => 12,
            Self::ArduPilot => 3,
            Self::Generic => 0,
        }
    }

    /// The number of the item of a mission at an index, as ground stations show it: from 1, and ArduPilot's from home, which is 0.
    pub fn item_number(self, index: usize) -> usize {
        if self.is_ardupilot() { index } else { index + 1 }
    }

    /// Whether clients expect ArduPilot's conventions.
    pub fn is_ardupilot(self) -> bool {
        self == Self::ArduPilot
    }
}
