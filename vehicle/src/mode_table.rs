//! The modes by the numbers and names of both autopilots: a mode is one row.

use crate::identity::Identity;
use crate::mode::Mode;

/// How clients of an autopilot know a mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KnownMode {
    /// The custom mode of HEARTBEAT.
    pub number: u32,
    /// Its name.
    pub name: &'static str,
    /// Whether a user may choose it.
    pub selectable: bool,
}

/// A mode as both autopilots know it; `None`: that one has no such mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Row {
    mode: Mode,
    px4: Option<KnownMode>,
    ardupilot: Option<KnownMode>,
}

const fn known(number: u32, name: &'static str) -> Option<KnownMode> {
    Some(KnownMode { number, name, selectable: true })
}

/// A mode that the vehicle shows as another one, whose number it has.
const fn shown_as(number: u32, name: &'static str) -> Option<KnownMode> {
    Some(KnownMode { number, name, selectable: false })
}

/// How PX4 composes a mode: main, and sub for its automatic ones.
const fn px4(main: u32, sub: u32) -> u32 {
    main << 16 | sub << 24
}

const fn row(mode: Mode, px4: Option<KnownMode>, ardupilot: Option<KnownMode>) -> Row {
    Row { mode, px4, ardupilot }
}

/// All modes, in the order in which they are listed.
#[rustfmt::skip] // One line per mode reads as the table that it is.
const MODES: &[Row] = &[
    row(Mode::Manual, known(px4(1, 0), "Manual"), None),
    row(Mode::Stabilize, known(px4(7, 0), "Stabilized"), known(0, "Stabilize")),
    row(Mode::Acro, known(px4(5, 0), "Acro"), known(1, "Acro")),
    row(Mode::Altitude, known(px4(2, 0), "Altitude"), known(2, "AltHold")),
    row(Mode::Position, known(px4(3, 0), "Position"), known(5, "Loiter")),
    row(Mode::PositionHold, None, known(16, "PosHold")),
    row(Mode::Hold, known(px4(4, 3), "Hold"), known(17, "Brake")),
    // ArduCopter takes off in its guided mode.
    row(Mode::Takeoff, known(px4(4, 2), "Takeoff"), shown_as(4, "Guided")),
    row(Mode::Mission, known(px4(4, 4), "Mission"), known(3, "Auto")),
    row(Mode::MissionLanding, None, known(27, "Auto RTL")),
    row(Mode::Return, known(px4(4, 5), "Return"), known(6, "RTL")),
    row(Mode::Land, known(px4(4, 6), "Land"), known(9, "Land")),
    row(Mode::Offboard, known(px4(6, 0), "Offboard"), known(4, "Guided")),
    row(Mode::GuidedAttitude, None, known(20, "Guided NoGPS")),
    row(Mode::Orbit, known(px4(3, 1), "Orbit"), known(7, "Circle")),
    row(Mode::Follow, known(px4(4, 8), "Follow Me"), known(23, "Follow")),
    row(Mode::SmartReturn, None, known(21, "Smart RTL")),
    row(Mode::Throw, None, known(18, "Throw")),
    row(Mode::Flip, None, known(14, "Flip")),
    row(Mode::ZigZag, None, known(24, "ZigZag")),
];

/// Other numbers that mean a mode: PX4's automatic mode without a sub-mode is the one that waits.
const PX4_ALIASES: &[(u32, Mode)] = &[(px4(4, 0), Mode::Hold), (px4(4, 1), Mode::Hold)];

impl Identity {
    /// The modes that such an autopilot has, in the order in which they are listed.
    fn modes(self) -> impl Iterator<Item = (Mode, KnownMode)> {
        MODES.iter().filter_map(move |row| {
            let known = if self.is_ardupilot() { row.ardupilot } else { row.px4 };
            Some((row.mode, known?))
        })
    }

    /// How clients know a mode; a mode that such an autopilot does not have is shown as the one that holds the place.
    fn known_mode(self, mode: Mode) -> KnownMode {
        let of = |wanted: Mode| self.modes().find(|(mode, _)| *mode == wanted);
        let none = KnownMode { number: 0, name: "", selectable: false };
        of(mode).or_else(|| of(Mode::Hold)).map_or(none, |(_, known)| known)
    }

    /// The custom mode of a HEARTBEAT.
    pub fn custom_mode(self, mode: Mode) -> u32 {
        self.known_mode(mode).number
    }

    /// Name of a mode, as users of such an autopilot know it.
    pub fn mode_name(self, mode: Mode) -> &'static str {
        self.known_mode(mode).name
    }

    /// The mode of a custom mode, if this vehicle has it.
    pub fn mode(self, custom_mode: u32) -> Option<Mode> {
        let aliases = if self.is_ardupilot() { &[][..] } else { PX4_ALIASES };
        let alias = aliases.iter().find(|(number, _)| *number == custom_mode).map(|(_, mode)| *mode);
        let chosen = |(_, known): &(Mode, KnownMode)| known.selectable && known.number == custom_mode;
        alias.or_else(|| self.modes().find(chosen).map(|(mode, _)| mode))
    }

    /// Modes that a user may choose, in the order in which they are listed.
    pub fn selectable_modes(self) -> impl Iterator<Item = Mode> {
        self.modes().filter(|(_, known)| known.selectable).map(|(mode, _)| mode)
    }

    /// The mode after the start.
    pub fn first_mode(self) -> Mode {
        if self.is_ardupilot() { Mode::Position } else { Mode::Hold }
    }

    /// The mode of a vehicle whose rotors have stopped in a mode. PX4 leaves what ends on the ground; ArduPilot stays in it until it is
    /// told another, and its takeoff is a part of the guided mode.
    pub fn mode_after_flight(self, mode: Mode) -> Mode {
        match mode {
            Mode::Takeoff if self.is_ardupilot() => Mode::Offboard,
            Mode::Land | Mode::Return | Mode::SmartReturn | Mode::Takeoff | Mode::Mission
                if !self.is_ardupilot() =>
            {
                self.first_mode()
            }
            mode => mode,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::MODES;
    use crate::identity::Identity;
    use crate::mode::Mode;

    #[test]
    fn every_selectable_mode_is_found_by_its_number() {
        for identity in [Identity::Px4, Identity::ArduPilot, Identity::Generic] {
            for mode in identity.selectable_modes() {
                assert_eq!(identity.mode(identity.custom_mode(mode)), Some(mode), "{identity:?}");
            }
        }
        assert_eq!(Identity::Px4.custom_mode(Mode::Offboard), 393_216);
        assert_eq!(Identity::Px4.mode(9 << 16), None);
        assert_eq!(Identity::ArduPilot.mode(15), None, "there is no automatic tuning");
    }

    /// ArduCopter's heartbeat shows Land, RTL and Auto after the landing, too; its clients choose the next mode.
    #[test]
    fn ardupilot_stays_in_the_mode_in_which_it_has_landed() {
        for mode in [Mode::Land, Mode::Return, Mode::SmartReturn, Mode::Mission, Mode::Stabilize] {
            assert_eq!(Identity::ArduPilot.mode_after_flight(mode), mode);
            let px4 = Identity::Px4.mode_after_flight(mode);
            assert_eq!(px4, if mode == Mode::Stabilize { mode } else { Mode::Hold });
        }
        assert_eq!(Identity::ArduPilot.mode_after_flight(Mode::Takeoff), Mode::Offboard);
    }

    #[test]
    fn a_mode_has_one_row() {
        let modes: BTreeSet<_> = MODES.iter().map(|row| format!("{:?}", row.mode)).collect();
        assert_eq!(modes.len(), MODES.len());
    }
}
