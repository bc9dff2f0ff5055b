//! Flight modes.

/// What decides where the vehicle flies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mode {
    /// Sticks command velocity; without a stick it holds its place.
    Position,
    /// Climbs to the takeoff height, then holds.
    Takeoff,
    /// Holds its place, or flies to one and holds there.
    Hold,
    /// Climbs, flies home and lands.
    Return,
    /// Flies the mission.
    Mission,
    /// Lands where it is.
    Land,
    /// Follows set-points (ArduPilot: guided).
    Offboard,
}

/// Who leads the vehicle in a mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Leader {
    /// The pilot with sticks.
    Sticks,
    /// A program outside with set-points.
    SetPoints,
    /// The vehicle itself.
    Vehicle,
}

impl Mode {
    /// Who leads the vehicle.
    pub fn leader(self) -> Leader {
        match self {
            Self::Position => Leader::Sticks,
            Self::Offboard => Leader::SetPoints,
            Self::Takeoff | Self::Hold | Self::Return | Self::Mission | Self::Land => Leader::Vehicle,
        }
    }

    /// Whether it ends on the ground: then it is not one to be armed in.
    pub fn ends_on_the_ground(self) -> bool {
        matches!(self, Self::Land | Self::Return | Self::Takeoff | Self::Mission)
    }
}
