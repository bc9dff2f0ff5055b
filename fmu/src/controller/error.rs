//! What the controllers refuse.

use quadrotor::{ConfigurationError, ControlError};
use thiserror::Error;

/// Why the controllers do not begin, or do not go on.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ControllerError {
    /// A configuration or a saved state.
    #[error(transparent)]
    Configuration(#[from] ConfigurationError),
    /// An input.
    #[error(transparent)]
    Control(#[from] ControlError),
    /// A measurement is not a number.
    #[error("{name} is not finite at {} s: connect it to a finite number", seconds(*time_us))]
    NotFinite {
        /// The variable.
        name: &'static str,
        /// When.
        time_us: u64,
    },
    /// A quaternion has no direction.
    #[error(
        "measured.attitude.q0 to q3 = {}, {}, {}, {} is no attitude at {} s; allowed: a norm of 1, at least 0.5; connect the attitude, \
         or set measurement.attitude to euler_angles and connect measured.attitude.phi, theta and psi",
        .quaternion[0], .quaternion[1], .quaternion[2], .quaternion[3], seconds(*time_us)
    )]
    NoAttitude {
        /// As it was measured.
        quaternion: [f64; 4],
        /// When.
        time_us: u64,
    },
    /// Time only goes forward.
    #[error("cannot advance to {} s: the controllers are already at {} s", seconds(*requested_us), seconds(*time_us))]
    Backwards {
        /// Time of the run.
        time_us: u64,
        /// Time asked for.
        requested_us: u64,
    },
}

/// A time in microseconds as messages show it, s.
fn seconds(time_us: u64) -> f64 {
    time_us as f64 / 1e6
}
