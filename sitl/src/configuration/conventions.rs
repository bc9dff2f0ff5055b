//! `--autopilot`: whose conventions to follow.

use clap::ValueEnum;
use vehicle::identity::Identity;

/// The values of the flag.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, ValueEnum)]
pub enum Conventions {
    /// PX4's autopilot id, modes, parameter encoding (bytewise), and takeoff altitude above sea level
    #[default]
    Px4,
    /// ArduPilot's autopilot id, copter modes, parameter encoding (cast), and takeoff altitude above home
    #[value(name = "ardupilot")]
    ArduPilot,
    /// Autopilot id "generic", the rest as PX4; QGroundControl then offers no guided actions
    Generic,
}

impl From<Conventions> for Identity {
    fn from(conventions: Conventions) -> Self {
        match conventions {
            Conventions::Px4 => Self::Px4,
            Conventions::ArduPilot => Self::ArduPilot,
            Conventions::Generic => Self::Generic,
        }
    }
}
