//! Why a parameter keeps its value.

use quadrotor::ConfigurationError;

/// Why a parameter was not changed. Nothing has changed then.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SetError {
    /// There is none of this name.
    #[error("there is no parameter {0}")]
    Unknown(String),
    /// The value is no number that it can have.
    #[error("{id} = {value} is outside [{minimum}, {maximum}]")]
    OutOfRange {
        /// Identifier.
        id: String,
        /// Given value.
        value: f64,
        /// Smallest allowed value.
        minimum: f64,
        /// Largest allowed value.
        maximum: f64,
    },
    /// The value is none of those that mean something.
    #[error("{id} = {value} has no meaning here: {meanings}")]
    Meaningless {
        /// Identifier.
        id: String,
        /// Given value.
        value: f64,
        /// Those that mean something, in words.
        meanings: String,
    },
    /// It is fixed since the start.
    #[error("{0} is set by the command line")]
    ReadOnly(String),
    /// It follows from other parameters.
    #[error("{0} is calculated from mass and rotors (read-only); set those instead")]
    Calculated(String),
    /// It can only change while the vehicle is disarmed on the ground.
    #[error("{0} is fixed while armed")]
    Armed(String),
    /// The closed loop refuses it.
    #[error("{id}: {source}")]
    Refused {
        /// Identifier.
        id: String,
        /// Why.
        source: Box<ConfigurationError>,
    },
}

impl SetError {
    /// The closed loop refuses the value of a parameter.
    pub fn refused(id: &str, source: ConfigurationError) -> Self {
        match source {
            ConfigurationError::Fixed { .. } => Self::Armed(id.to_owned()),
            source => Self::Refused { id: id.to_owned(), source: Box::new(source) },
        }
    }
}
