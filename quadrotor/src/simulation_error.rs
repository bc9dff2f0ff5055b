//! What can happen to a flight.

use thiserror::Error;

use crate::ControlError;

/// Why a flight could not go on.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// An input is not finite.
    #[error("the input {name} is not finite at {time_us} µs")]
    InputNotFinite {
        /// Public name of the input.
        name: &'static str,
        /// When.
        time_us: u64,
    },
    /// The control loop cannot do what it is asked for.
    #[error(transparent)]
    Control(ControlError),
    /// Time only goes forward.
    #[error("cannot advance to {requested_us} µs: the flight is already at {time_us} µs")]
    Backwards {
        /// Time of the flight.
        time_us: u64,
        /// Time asked for.
        requested_us: u64,
    },
    /// The state has left the range of finite numbers.
    #[error("the state is no longer finite at {time_us} µs")]
    Diverged {
        /// When.
        time_us: u64,
    },
}

impl From<ControlError> for SimulationError {
    fn from(error: ControlError) -> Self {
        match error {
            ControlError::InputNotFinite { name, time_us } => Self::InputNotFinite { name, time_us },
            other => Self::Control(other),
        }
    }
}
