//! Errors.

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
    /// Standard output cannot be written.
    #[error("cannot write the output: {0}")]
    Output(std::io::Error),
    /// A model file is invalid.
    #[error("{name}: {reason}")]
    Model {
        /// The file, or the key in it.
        name: String,
        /// What is wrong.
        reason: String,
    },
    /// The reference solver found no solution.
    #[error("the {problem} cannot be solved: {reason}")]
    Solver {
        /// The step.
        problem: String,
        /// What the solver says.
        reason: String,
    },
    /// The file of optimal flights is not one.
    #[error("invalid optimal flights: {0}")]
    Optimum(String),
    /// A figure cannot be drawn.
    #[error("{name}: {reason}")]
    Picture {
        /// Its name.
        name: String,
        /// Why.
        reason: String,
    },
    /// A controller cannot be designed.
    #[error("invalid design: {0}")]
    Design(#[from] lmpc::DesignError),
    /// A configuration cannot be flown.
    #[error(transparent)]
    Configuration(#[from] quadrotor::ConfigurationError),
}
