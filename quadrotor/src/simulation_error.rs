//! What can happen to a flight.

use core::fmt;

use thiserror::Error;

use crate::control::control_error::seconds;
use crate::{ControlError, Overload};

/// Why a flight could not go on.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// An input is not finite.
    #[error("the input {name} is not finite at {} s", seconds(*time_us))]
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
    #[error("cannot advance to {} s: the flight is already at {} s", seconds(*requested_us), seconds(*time_us))]
    Backwards {
        /// Time of the flight.
        time_us: u64,
        /// Time asked for.
        requested_us: u64,
    },
    /// The state has left the range of numbers: see [`PlantState::has_diverged`](crate::PlantState::has_diverged).
    #[error("the motion has diverged at {} s{}", seconds(*time_us), Because(.overload.as_ref()))]
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

#[cfg(test)]
mod tests {
    use alloc::string::ToString;

    use super::SimulationError;

    #[test]
    fn messages_show_seconds() {
        let shown = [
            SimulationError::Diverged { time_us: 1_067_001, overload: None },
            SimulationError::Backwards { time_us: 60_000_000, requested_us: 300_000 },
        ]
        .map(|error| error.to_string());
        assert_eq!(
            shown,
            [
                "the motion has diverged at 1.067001 s",
                "cannot advance to 0.3 s: the flight is already at 60 s"
            ]
        );
    }
}
