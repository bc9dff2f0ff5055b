//! Why a control loop did not sample.

use thiserror::Error;

/// Why a control loop did not sample. Its state is the one before the sample then.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ControlError {
    /// An input is not finite.
    #[error("the input {name} is not finite at {} s", seconds(*time_us))]
    InputNotFinite {
        /// Public name of the input.
        name: &'static str,
        /// When.
        time_us: u64,
    },
    /// A measurement is not finite, or its quaternion is far from a unit one.
    #[error("the measurement at {} s is not finite or has no valid attitude", seconds(*time_us))]
    Measurement {
        /// When.
        time_us: u64,
    },
    /// There is no such rotor to be lost.
    #[error("lost_rotor = {rotor}; allowed 0–3")]
    NoSuchRotor {
        /// Index asked for.
        rotor: usize,
    },
    /// The airframe cannot be flown without this rotor.
    #[error("the airframe cannot be controlled without rotor {rotor}")]
    NoRotorLossLaw {
        /// Index of the lost rotor.
        rotor: usize,
    },
    /// The shaper is asked for, which this build was made without.
    #[error("shaping needs the cargo feature \"shaper\"")]
    NoShaper,
}

/// A time in microseconds as messages show it, s.
pub fn seconds(time_us: u64) -> f64 {
    time_us as f64 / 1e6
}
