//! Flight modes.

/// What decides where the vehicle flies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mode {
    /// Sticks command velocity; without a stick it holds its place.
    Position,
    /// Sticks lean the vehicle; released ones hold its place (ArduPilot: POSHOLD).
    PositionHold,
    /// Sticks lean the vehicle, the throttle commands the climb rate.
    Altitude,
    /// Sticks lean the vehicle, the throttle is the thrust.
    Stabilize,
    /// The same, as PX4 shows it when it is asked for its manual mode.
    Manual,
    /// Sticks command rates about the body's axes, the throttle is the thrust.
    Acro,
    /// Climbs to the takeoff height, then holds.
    Takeoff,
    /// Holds its place, or flies to one and holds there.
    Hold,
    /// Climbs, flies home and lands.
    Return,
    /// Flies the mission.
    Mission,
    /// Flies the landing of the mission in place of a way home (ArduPilot: AUTO_RTL). It is chosen and shown; what flies is [`Self::Mission`].
    MissionLanding,
    /// Lands where it is.
    Land,
    /// Follows set-points (ArduPilot: guided).
    Offboard,
    /// Follows attitudes that are set from outside, and no places (ArduPilot: guided without GPS).
    GuidedAttitude,
    /// Flies around a centre (ArduPilot: circle).
    Orbit,
    /// Follows a target that moves.
    Follow,
    /// Flies back along its own way and lands.
    SmartReturn,
    /// Turns over once and goes on as before (ArduPilot: FLIP).
    Flip,
    /// By sticks between two ends that a switch flies across to (ArduPilot: ZIGZAG).
    ZigZag,
    /// Waits until it is thrown, and catches itself (ArduPilot: THROW).
    Throw,
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

/// What of its motion the vehicle must know.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Needs {
    /// How it leans.
    Attitude,
    /// And how high it is.
    Height,
    /// And where it is.
    Place,
}

impl Mode {
    /// Who leads the vehicle.
    pub fn leader(self) -> Leader {
        match self {
            Self::Position
            | Self::PositionHold
            | Self::ZigZag
            | Self::Altitude
            | Self::Stabilize
            | Self::Manual
            | Self::Acro => Leader::Sticks,
            Self::Offboard | Self::GuidedAttitude => Leader::SetPoints,
            Self::Takeoff
            | Self::Hold
            | Self::Return
            | Self::SmartReturn
            | Self::Mission
            | Self::MissionLanding
            | Self::Land
            | Self::Orbit
            | Self::Follow
            | Self::Flip
            | Self::Throw => Leader::Vehicle,
        }
    }

    /// Whether the throttle is the thrust.
    pub fn is_flown_by_thrust(self) -> bool {
        matches!(self, Self::Stabilize | Self::Manual | Self::Acro)
    }

    /// Whether it holds the present place, whatever its coordinates, or moves from there as the sticks command.
    pub fn holds_a_felt_place(self) -> bool {
        matches!(self, Self::Hold | Self::Position | Self::PositionHold)
    }

    /// What of its motion the vehicle must know for it.
    pub fn needs(self) -> Needs {
        match self {
            Self::Stabilize | Self::Manual | Self::Acro | Self::Flip => Needs::Attitude,
            Self::Altitude | Self::GuidedAttitude => Needs::Height,
            _ => Needs::Place,
        }
    }
}
