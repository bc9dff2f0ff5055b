//! What is wrong with a parameter file.

use crate::parameters::SetError;

/// What is wrong with a parameter file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ParameterFileError {
    /// A line has none of the known forms.
    #[error("line {line}: expected `NAME VALUE`, got `{text}`")]
    Malformed {
        /// Number of the line, from one.
        line: usize,
        /// The line.
        text: String,
    },
    /// A name or value is refused.
    #[error("line {line}: {source}")]
    Refused {
        /// Number of the line, from one.
        line: usize,
        /// Why.
        source: SetError,
    },
}
