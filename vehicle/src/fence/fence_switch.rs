//! What MAV_CMD_DO_FENCE_ENABLE asks for.

/// How the fence is switched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FenceSwitch {
    /// Off, as a whole.
    Off,
    /// On, as a whole.
    On,
    /// Only its floor is off, until the fence is switched on or off again or the vehicle disarms.
    FloorOff,
    /// These parts are off, by the bits of ArduPilot's FENCE_TYPE; the others stay as they are.
    PartsOff(u8),
    /// These parts are on, by the same bits; the others stay as they are.
    PartsOn(u8),
}

/// The bits of all parts.
const ALL: u8 = 15;

impl FenceSwitch {
    /// On or off.
    pub fn on(on: bool) -> Self {
        if on { Self::On } else { Self::Off }
    }

    /// By the first two parameters of the command: what to do, and with which parts, 0 for all of them.
    pub fn of_numbers(number: f64, parts: f64) -> Option<Self> {
        let parts = (0..=ALL).find(|bits| f64::from(*bits) == parts)?;
        let some = parts != 0 && parts != ALL;
        match number {
            0.0 if some => Some(Self::PartsOff(parts)),
            1.0 if some => Some(Self::PartsOn(parts)),
            0.0 => Some(Self::Off),
            1.0 => Some(Self::On),
            2.0 => Some(Self::FloorOff),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::FenceSwitch;

    #[test]
    fn the_command_names_what_to_do_and_with_which_parts() {
        let of = FenceSwitch::of_numbers;
        assert_eq!([of(0.0, 0.0), of(1.0, 15.0)], [Some(FenceSwitch::Off), Some(FenceSwitch::On)]);
        assert_eq!(of(0.0, 1.0), Some(FenceSwitch::PartsOff(1)));
        assert_eq!(of(1.0, 6.0), Some(FenceSwitch::PartsOn(6)));
        assert_eq!([of(3.0, 0.0), of(1.0, 16.0), of(1.0, 0.5), of(f64::NAN, 0.0)], [None; 4]);
    }
}
