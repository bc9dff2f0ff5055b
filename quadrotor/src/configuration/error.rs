//! What can be wrong with a configuration.

use lmpc::DesignError;
use thiserror::Error;

/// Why a configuration was refused. Nothing has changed then.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ConfigurationError {
    /// A value is outside its range.
    #[error("{name} = {value} is outside [{minimum}, {maximum}]")]
    OutOfRange {
        /// Public name of the parameter.
        name: &'static str,
        /// Given value.
        value: f64,
        /// Smallest allowed value.
        minimum: f64,
        /// Largest allowed value.
        maximum: f64,
    },
    /// Two values do not fit together.
    #[error("{name} = {value} must be {relation} {other} = {other_value}")]
    Inconsistent {
        /// Public name of the parameter.
        name: &'static str,
        /// Its value.
        value: f64,
        /// "below", "at most", …
        relation: &'static str,
        /// What it is compared with.
        other: &'static str,
        /// The other value.
        other_value: f64,
    },
    /// A controller or the Kalman predictor cannot be designed.
    #[error("the {part} cannot be designed: {source}")]
    Design {
        /// What, for a person: "altitude controller", "Kalman predictor", …
        part: &'static str,
        /// Why not.
        source: DesignError,
    },
    /// The rotors are not laid out as those of a quadrotor.
    #[error("airframe.layout cannot be flown: {reason}")]
    Layout {
        /// What is wrong with it.
        reason: &'static str,
    },
    /// A function that this build was made without.
    #[error("{name} = true needs the cargo feature \"shaper\"")]
    Unavailable {
        /// Public name of the parameter.
        name: &'static str,
    },
    /// The measurement in which a control loop should take its vehicle over is not finite, or its quaternion is far from a
    /// unit one.
    #[error("the first measurement is not finite, or has no attitude")]
    Measurement,
    /// A saved state that no flight with this configuration can have been in.
    #[error("the saved state is none of this flight: {reason}")]
    State {
        /// What is wrong with it.
        reason: &'static str,
    },
    /// A parameter that describes the start of the flight would change.
    #[error("{name} is fixed for the whole flight: a change takes effect at the next start")]
    Fixed {
        /// Public name of the parameter.
        name: &'static str,
    },
}
