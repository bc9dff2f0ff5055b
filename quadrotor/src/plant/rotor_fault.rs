//! Rotors that do not turn as they are told.

use serde::{Deserialize, Serialize};

use crate::plant::differentiation::real::Real;

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

/// The speeds that rotors go to, rad/s, under commanded speeds and at their present ones.
pub(crate) fn goals_rad_s<T: Real>(
    faults: &[Option<RotorFault>; 4],
    command_rad_s: &[T; 4],
    present_rad_s: &[T; 4],
) -> [T; 4] {
    core::array::from_fn(|rotor| match faults[rotor] {
        Some(fault) => fault.goal_rad_s(command_rad_s[rotor], present_rad_s[rotor]),
        None => command_rad_s[rotor],
    })
}

impl RotorFault {
    /// The speed that the rotor goes to, rad/s, under a commanded speed and at its present speed.
    fn goal_rad_s<T: Real>(self, command_rad_s: T, present_rad_s: T) -> T {
        match self {
            Self::Off => T::zero(),
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

#[cfg(test)]
mod tests {
    use super::RotorFault;

    #[test]
    fn each_fault_has_its_goal() {
        assert_eq!(RotorFault::Off.goal_rad_s(300.0, 250.0), 0.0);
        assert_eq!(RotorFault::Stuck.goal_rad_s(300.0, 250.0), 250.0);
        // A quarter of the thrust is half of the speed.
        assert_eq!(RotorFault::Weak { share: 0.25 }.goal_rad_s(300.0, 250.0), 150.0);
    }

    #[test]
    fn a_share_lies_between_nothing_and_all() {
        assert!(RotorFault::Off.is_valid() && RotorFault::Stuck.is_valid());
        assert!([0.0, 0.5, 1.0].into_iter().all(|share| RotorFault::Weak { share }.is_valid()));
        assert!(![-1e-9, 1.000_001, f64::NAN].into_iter().any(|share| RotorFault::Weak { share }.is_valid()));
    }
}
