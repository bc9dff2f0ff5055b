//! Errors that end the program, and their exit codes.

use std::io;
use std::path::{Path, PathBuf};

use quadrotor::{ConfigurationError, SimulationError};
use vehicle::FlightError;
use vehicle::parameters::{ParameterFileError, SetError};
use viewer::ViewerError;

use crate::fleet::Loss;
use crate::link::LinkError;

/// One line for the user, and an exit code.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// A value, from wherever it came.
    #[error("{name}: {reason}")]
    Value {
        /// What was set.
        name: String,
        /// What is wrong with it.
        reason: String,
    },
    /// A command line that cannot be read.
    #[error("{0} (see --help)")]
    Usage(String),
    /// The closed loop cannot be built.
    #[error(transparent)]
    Configuration(#[from] ConfigurationError),
    /// A parameter of the command line.
    #[error("--set: {0}")]
    Set(#[from] SetError),
    /// The parameter file.
    #[error("{}: {source}", path.display())]
    Parameters {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: ParameterFileError,
    },
    /// A port or device.
    #[error(transparent)]
    Link(#[from] LinkError),
    /// The live page.
    #[error("--view: {0}")]
    View(#[from] ViewerError),
    /// A file that cannot be read or written.
    #[error("cannot {action} {}: {source}", path.display())]
    File {
        /// "read" or "write".
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A file with wrong content.
    #[error("{}: {reason}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// Files lack some of what they should hold, a sentence each; the flights ended as asked.
    #[error("the flight ended as asked, but files are incomplete: {}", .0.join("; "))]
    Incomplete(Vec<String>),
    /// The replayed flight is another one.
    #[error(
        "the replayed flight of system {system_id} differs from the recorded one by {:.3} s: flight digest {replayed:016x} \
         instead of {recorded:016x}",
        *time_us as f64 / 1e6
    )]
    Differs {
        /// The vehicle.
        system_id: u8,
        /// Simulation time of the comparison, µs.
        time_us: u64,
        /// Digest in the record.
        recorded: u64,
        /// Digest of the replayed flight.
        replayed: u64,
    },
    /// The simulation of the only vehicle cannot go on.
    #[error("the simulation failed: {0}")]
    Simulation(#[from] SimulationError),
    /// The flight cannot go on, or begin.
    #[error("the simulation failed: {0}")]
    Flight(#[from] FlightError),
    /// The simulation of vehicles of a fleet could not go on; the others flew to their end.
    #[error("the simulation failed: {}", .0.iter().map(Loss::to_string).collect::<Vec<_>>().join("; "))]
    Lost(Vec<Loss>),
    /// The replayed flight of a vehicle goes on where the recorded one failed.
    #[error(
        "the replayed flight of system {system_id} goes on at {:.3} s, where the recorded simulation failed",
        *time_us as f64 / 1e6
    )]
    FliesOn {
        /// The vehicle.
        system_id: u8,
        /// Simulation time of the recorded failure, µs.
        time_us: u64,
    },
    /// The handlers of signals.
    #[error("cannot handle signals: {0}")]
    Signals(io::Error),
}

impl Failure {
    /// A file that cannot be written.
    pub fn write(path: &Path, source: io::Error) -> Self {
        Self::File { action: "write", path: path.to_owned(), source }
    }

    /// A file that cannot be read.
    pub fn read(path: &Path, source: io::Error) -> Self {
        Self::File { action: "read", path: path.to_owned(), source }
    }

    /// Exit code of the program.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Flight(error) => code_of(error),
            // Whoever asks why finds out about what is not ours first.
            Self::Lost(losses) => losses.iter().map(|loss| code_of(&loss.error)).max().unwrap_or(1),
            Self::Simulation(_) | Self::Signals(_) => 1,
            Self::Value { .. } | Self::Usage(_) | Self::Configuration(_) | Self::Set(_) => 2,
            Self::Link(_) | Self::View(_) => 3,
            Self::File { .. } | Self::Content { .. } | Self::Parameters { .. } | Self::Incomplete(_) => 4,
            Self::Differs { .. } | Self::FliesOn { .. } => 5,
        }
    }
}

/// Exit code of a flight that could not go on.
fn code_of(error: &FlightError) -> u8 {
    match error {
        FlightError::Simulation(_) => 1,
        FlightError::Configuration(_) => 2,
        FlightError::Foreign { .. } => 6,
    }
}
