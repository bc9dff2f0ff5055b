//! What can happen to a flight.

use core::fmt;

use thiserror::Error;

use crate::{ControlError, Overload};

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
    /// The state has left the range of numbers: see [`PlantState::has_diverged`](crate::PlantState::has_diverged).
    #[error("the motion has diverged at {time_us} µs{}", Because(.overload.as_ref()))]
    Diverged {
        /// When.
        time_us: u64,
        /// What the rotors could not counter then, if anything: the probable cause.
        overload: Option<Overload>,
    },
}

/// The end of a sentence about an overload.
struct Because<'a>(Option<&'a Overload>);

impl fmt::Display for Because<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.map_or(Ok(()), |overload| write!(formatter, "; {overload}"))
    }
}

impl From<ControlError> for SimulationError {
    fn from(error: ControlError) -> Self {
        match error {
            ControlError::InputNotFinite { name, time_us } => Self::InputNotFinite { name, time_us },
            other => Self::Control(other),
        }
    }
}
