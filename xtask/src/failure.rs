//! What can go wrong, each as one line with the remedy.

use std::io;
use std::path::PathBuf;
use std::process::ExitStatus;

use quadrotor::{ConfigurationError, SimulationError};
use thiserror::Error;

/// Why a task failed.
#[derive(Debug, Error)]
pub enum Failure {
    /// A program is not installed.
    #[error("{program} was not found: {remedy}")]
    Missing {
        /// Its name.
        program: String,
        /// How to get it.
        remedy: &'static str,
    },
    /// A program could not be started.
    #[error("{program} could not be started: {source}")]
    Start {
        /// Its name.
        program: String,
        /// Why.
        source: io::Error,
    },
    /// A program ended with an error, after saying why.
    #[error("{what} failed ({status}); see its output above")]
    Ended {
        /// What it did.
        what: String,
        /// How it ended.
        status: ExitStatus,
    },
    /// A program answered something else than expected.
    #[error("{what} gave an answer that cannot be read: {detail}")]
    Answer {
        /// What it was asked for.
        what: &'static str,
        /// What is wrong with it.
        detail: String,
    },
    /// Python is too old.
    #[error(
        "{program} is Python {version}, and the pinned packages need 3.10 or newer: \
         install one and name it in the environment variable PYTHON"
    )]
    OldPython {
        /// The interpreter.
        program: String,
        /// Its version.
        version: String,
    },
    /// Python comes without what makes virtual environments.
    #[error(
        "{program} has no venv and pip: on Debian and Ubuntu install python3-venv, elsewhere Python from python.org"
    )]
    NoVenv {
        /// The interpreter.
        program: String,
    },
    /// pip failed, after saying why.
    #[error(
        "the pinned Python packages could not be installed; see pip's output above (the first run needs a network)"
    )]
    Packages,
    /// A file or folder could not be read or written.
    #[error("cannot {action} {}: {source}", path.display())]
    File {
        /// "read", "write", …
        action: &'static str,
        /// Which.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// An archive could not be read or written.
    #[error("{} is not a readable FMU archive: {source}", path.display())]
    Archive {
        /// Which.
        path: PathBuf,
        /// Why.
        source: zip::result::ZipError,
    },
    /// An FMU to merge is of other sources.
    #[error("{} has another modelDescription.xml: build it from the same sources", path.display())]
    OtherModel {
        /// Which.
        path: PathBuf,
    },
    /// An FMU to merge has nothing to add.
    #[error("{} has no binaries of a further platform", path.display())]
    NothingToMerge {
        /// Which.
        path: PathBuf,
    },
    /// No FMI 2.0 platform name for the machine.
    #[error("FMI 2.0 has no platform name for {os} on {architecture}")]
    Platform {
        /// Operating system.
        os: &'static str,
        /// Processor.
        architecture: &'static str,
    },
    /// The flight of the documentation's picture could not be configured.
    #[error("the documentation's flight: {0}")]
    Configuration(#[from] ConfigurationError),
    /// The flight of the documentation's picture could not be flown.
    #[error("the documentation's flight: {0}")]
    Flight(#[from] SimulationError),
    /// A demo flight missed its goal, as its table says.
    #[error("a flight missed its goal; see the lines marked MISSED above")]
    GoalMissed,
    /// Tests failed, after saying which.
    #[error("{failed} failed; see above")]
    Tests {
        /// The suites.
        failed: String,
    },
}
