//! What the vehicle presents itself as: it decides what clients show and how they encode.

use serde::{Deserialize, Serialize};

use crate::mode::Mode;

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

/// How PX4 composes a mode: main, and sub for its automatic ones.
const fn px4(main: u32, sub: u32) -> u32 {
    main << 16 | sub << 24
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

    /// The custom mode of a HEARTBEAT.
    pub fn custom_mode(self, mode: Mode) -> u32 {
        if self.is_ardupilot() {
            return match mode {
                // ArduCopter takes off in its guided mode.
                Mode::Takeoff | Mode::Offboard => 4,
                Mode::Position => 5,
                Mode::Mission => 3,
                // BRAKE
                Mode::Hold => 17,
                Mode::Return => 6,
                Mode::Land => 9,
            };
        }
        match mode {
            Mode::Position => px4(3, 0),
            Mode::Takeoff => px4(4, 2),
            Mode::Hold => px4(4, 3),
            Mode::Mission => px4(4, 4),
            Mode::Return => px4(4, 5),
            Mode::Land => px4(4, 6),
            Mode::Offboard => px4(6, 0),
        }
    }

    /// The mode of a custom mode, if this vehicle has it.
    pub fn mode(self, custom_mode: u32) -> Option<Mode> {
        if self.is_ardupilot() {
            return match custom_mode {
                3 => Some(Mode::Mission),
                4 => Some(Mode::Offboard),
                // LOITER and POSHOLD
                5 | 16 => Some(Mode::Position),
                6 => Some(Mode::Return),
                9 => Some(Mode::Land),
                17 => Some(Mode::Hold),
                _ => None,
            };
        }
        // Without a sub-mode PX4's automatic mode is the one that waits.
        if custom_mode == px4(4, 0) || custom_mode == px4(4, 1) {
            return Some(Mode::Hold);
        }
        Mode::ALL.into_iter().find(|mode| self.custom_mode(*mode) == custom_mode)
    }

    /// The mode after the start.
    pub fn first_mode(self) -> Mode {
        if self.is_ardupilot() { Mode::Position } else { Mode::Hold }
    }

    /// Modes that a user may choose, in the order in which they are listed.
    pub fn selectable_modes(self) -> &'static [Mode] {
        if self.is_ardupilot() {
            &[Mode::Position, Mode::Offboard, Mode::Mission, Mode::Return, Mode::Land, Mode::Hold]
        } else {
            &[
                Mode::Position,
                Mode::Hold,
                Mode::Takeoff,
                Mode::Mission,
                Mode::Return,
                Mode::Land,
                Mode::Offboard,
            ]
        }
    }

    /// Name of a mode, as users of such an autopilot know it.
    pub fn mode_name(self, mode: Mode) -> &'static str {
        match (self.is_ardupilot(), mode) {
            (true, Mode::Position) => "Loiter",
            (true, Mode::Hold) => "Brake",
            (true, Mode::Mission) => "Auto",
            (true, Mode::Takeoff | Mode::Offboard) => "Guided",
            (true, Mode::Return) => "RTL",
            (_, Mode::Land) => "Land",
            (false, Mode::Position) => "Position",
            (false, Mode::Hold) => "Hold",
            (false, Mode::Mission) => "Mission",
            (false, Mode::Takeoff) => "Takeoff",
            (false, Mode::Return) => "Return",
            (false, Mode::Offboard) => "Offboard",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Identity;
    use crate::mode::Mode;

    #[test]
    fn every_selectable_mode_is_found_by_its_number() {
        for identity in [Identity::Px4, Identity::ArduPilot, Identity::Generic] {
            for mode in identity.selectable_modes() {
                assert_eq!(identity.mode(identity.custom_mode(*mode)), Some(*mode), "{identity:?}");
            }
        }
        assert_eq!(Identity::Px4.custom_mode(Mode::Offboard), 393_216);
        assert_eq!(Identity::Px4.mode(1 << 16), None, "there is no manual mode");
        assert_eq!(Identity::ArduPilot.mode(0), None, "there is no stabilize mode");
    }
}
