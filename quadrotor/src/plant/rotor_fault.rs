//! Rotors that do not turn as they are told.

use serde::{Deserialize, Serialize};

/// What is wrong with a rotor. Disarmed, all of them come to rest.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum RotorFault {
    /// Its motor has no power: it comes to rest with the rotor's lag.
    Off,
    /// It turns on at the speed that it had.
    Stuck,
    /// It reaches only the speed that makes this share of the thrust that it was commanded to make.
    Weak {
        /// Share of the thrust, 0 to 1.
        share: f64,
    },
}

impl RotorFault {
    /// The speed that the rotor goes to, rad/s, under a commanded speed and at its present speed.
    pub(crate) fn goal_rad_s(self, command_rad_s: f64, present_rad_s: f64) -> f64 {
        match self {
            Self::Off => 0.0,
            Self::Stuck => present_rad_s,
            // Thrust and drag torque go with ω².
            Self::Weak { share } => command_rad_s * libm::sqrt(share),
        }
    }

    /// Whether its numbers mean something.
    pub fn is_valid(self) -> bool {
        match self {
            Self::Off | Self::Stuck => true,
            Self::Weak { share } => (0.0..=1.0).contains(&share),
        }
    }
}
