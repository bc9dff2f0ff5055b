//! What can go wrong.

use std::path::PathBuf;

use thiserror::Error;

/// Why there is no result; one line each.
#[derive(Debug, Error)]
pub enum Error {
    /// A file cannot be read or written.
    #[error("{}: {source}", path.display())]
    File {
        /// Which.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A model file is not what it should be.
    #[error("{name}: {reason}")]
    Model {
        /// The file, or the key in it.
        name: String,
        /// What is wrong.
        reason: String,
    },
    /// The judge of our solver has no answer.
    #[error("no optimum of the {problem}: {reason}")]
    Solver {
        /// The step.
        problem: String,
        /// What the solver says.
        reason: String,
    },
    /// A figure cannot be drawn.
    #[error("{name}: {reason}")]
    Picture {
        /// Its name.
        name: String,
        /// Why.
        reason: String,
    },
    /// A controller cannot be designed.
    #[error("the design is refused: {0}")]
    Design(#[from] lmpc::DesignError),
}
