//! What a failsafe is for.

/// Causes, in the order in which they are looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Cause {
    /// A rotor is lost: the vehicle descends on the others.
    RotorFailure,
    /// The estimator does not know the place any more.
    PositionLost,
    /// The battery is about to be empty.
    BatteryEmergency,
    /// The battery only just suffices for the way home.
    BatteryCritical,
    /// The battery is low.
    BatteryLow,
    /// The vehicle is beyond the fence, or cannot stop before it.
    Fence,
    /// The wind is stronger than allowed.
    HighWind,
    /// No ground station has been heard for a while, after one was.
    GroundStationLost,
    /// The set-points of the offboard mode have stopped.
    SetPointsLost,
    /// The pilot's radio or joystick is not received any more.
    PilotLost,
}

impl Cause {
    /// All causes.
    pub const ALL: [Self; 10] = [
        Self::RotorFailure,
        Self::PositionLost,
        Self::BatteryEmergency,
        Self::BatteryCritical,
        Self::BatteryLow,
        Self::Fence,
        Self::HighWind,
        Self::GroundStationLost,
        Self::SetPointsLost,
        Self::PilotLost,
    ];

    /// Words for the pilot.
    pub fn name(self) -> &'static str {
        match self {
            Self::RotorFailure => "Rotor failure",
            Self::PositionLost => "Position lost",
            Self::BatteryEmergency => "Battery empty",
            Self::BatteryCritical => "Battery critical",
            Self::BatteryLow => "Battery low",
            Self::Fence => "Fence breached",
            Self::HighWind => "High wind",
            Self::GroundStationLost => "Ground station lost",
            Self::SetPointsLost => "Set-points lost",
            Self::PilotLost => "Manual control lost",
        }
    }

    /// Words for the pilot once the cause is gone.
    pub fn cleared(self) -> &'static str {
        match self {
            Self::RotorFailure => "no rotor known to be lost",
            Self::PositionLost => "position known",
            Self::BatteryEmergency => "battery no longer empty",
            Self::BatteryCritical => "battery no longer critical",
            Self::BatteryLow => "battery no longer low",
            Self::Fence => "inside fence",
            Self::HighWind => "wind below limit",
            Self::GroundStationLost => "ground station connected",
            Self::SetPointsLost => "set-points received",
            Self::PilotLost => "manual control regained",
        }
    }

    /// Whether nobody may fly on while it lasts: the vehicle only lands.
    pub fn leaves_no_choice(self) -> bool {
        matches!(self, Self::PositionLost | Self::RotorFailure)
    }

    /// Whether the flight is about to end by itself, for the system status in HEARTBEAT.
    pub fn is_emergency(self) -> bool {
        matches!(self, Self::RotorFailure | Self::BatteryEmergency)
    }
}
