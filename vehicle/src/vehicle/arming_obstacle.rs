//! What speaks against arming.

use std::fmt::{self, Display, Formatter};

/// What an obstacle is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ArmingSubject {
    /// It is not on the ground.
    Ground,
    /// It lies tilted.
    Tilt,
    /// The battery is too weak.
    Battery,
    /// The gyroscopes.
    Gyroscope,
    /// The accelerometers.
    Accelerometer,
    /// The magnetometer.
    Magnetometer,
    /// The barometer.
    Barometer,
    /// The GPS receiver.
    Gps,
    /// The estimate of the attitude.
    Attitude,
    /// The estimate of the velocity.
    Velocity,
    /// The estimate of the position.
    Position,
    /// A rotor.
    Rotor,
    /// The mode of now cannot be armed in.
    Mode,
    /// The mission of the mission mode.
    Mission,
    /// The set-points of the offboard mode.
    SetPoints,
    /// A failsafe.
    Failsafe,
    /// Something else.
    Other,
}

impl ArmingSubject {
    /// All of them.
    pub const ALL: [Self; 17] = [
        Self::Ground,
        Self::Tilt,
        Self::Battery,
        Self::Gyroscope,
        Self::Accelerometer,
        Self::Magnetometer,
        Self::Barometer,
        Self::Gps,
        Self::Attitude,
        Self::Velocity,
        Self::Position,
        Self::Rotor,
        Self::Mode,
        Self::Mission,
        Self::SetPoints,
        Self::Failsafe,
        Self::Other,
    ];

    /// Whether only the mode of now has it: in another one it could be armed.
    pub fn is_of_mode(self) -> bool {
        matches!(self, Self::Mode | Self::Mission | Self::SetPoints)
    }
}

/// What speaks against arming.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ArmingObstacle {
    /// What it is about.
    pub subject: ArmingSubject,
    /// In words.
    pub text: String,
}

impl ArmingObstacle {
    /// About something, in words.
    pub fn new(subject: ArmingSubject, text: impl Into<String>) -> Self {
        Self { subject, text: text.into() }
    }
}

impl From<String> for ArmingObstacle {
    fn from(text: String) -> Self {
        Self::new(ArmingSubject::Other, text)
    }
}

impl Display for ArmingObstacle {
    fn fmt(&self, to: &mut Formatter<'_>) -> fmt::Result {
        to.write_str(&self.text)
    }
}

/// Several of them as one line.
pub fn joined(obstacles: &[ArmingObstacle]) -> String {
    let texts: Vec<&str> = obstacles.iter().map(|obstacle| obstacle.text.as_str()).collect();
    texts.join("; ")
}
