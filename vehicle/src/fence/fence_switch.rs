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
}

impl FenceSwitch {
    /// On or off.
    pub fn on(on: bool) -> Self {
        if on { Self::On } else { Self::Off }
    }

    /// By the first parameter of the command.
    pub fn of_number(number: f64) -> Option<Self> {
        match number {
            0.0 => Some(Self::Off),
            1.0 => Some(Self::On),
            2.0 => Some(Self::FloorOff),
            _ => None,
        }
    }
}
