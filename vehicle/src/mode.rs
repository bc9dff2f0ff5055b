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

impl Mode {
    /// All modes.
    pub const ALL: [Self; 7] =
        [Self::Position, Self::Takeoff, Self::Hold, Self::Mission, Self::Return, Self::Land, Self::Offboard];
}
