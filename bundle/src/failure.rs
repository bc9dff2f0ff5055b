//! What can go wrong, each as one line with the remedy.

use std::path::PathBuf;

use quadrotor::{ConfigurationError, SimulationError};
use thiserror::Error;

/// Why nothing was written.
#[derive(Debug, Error)]
pub enum Failure {
    /// A file, or a question to cargo.
    #[error(transparent)]
    Tool(#[from] xtask::failure::Failure),
    /// An archive could not be read or written.
    #[error("{} is not a readable FMU archive: {source}", path.display())]
    Archive {
        /// Which.
        path: PathBuf,
        /// Why.
        source: zip::result::ZipError,
    },
    /// An FMU to merge is of other sources.
    #[error("{} has a different modelDescription.xml: build it from the same sources", path.display())]
    OtherModel {
        /// Which.
        path: PathBuf,
    },
    /// An FMU to merge has nothing to add.
    #[error("{} has no binaries for another platform", path.display())]
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
    /// A library of an FMU is for a platform that FMI 3.0 has no name for here.
    #[error("{path} is not a library of a known platform: Linux, Windows or macOS on x86, x86-64 or ARM64")]
    UnknownLibrary {
        /// Its place in the FMU.
        path: String,
    },
    /// The model's own description is not XML.
    #[error("modelDescription.xml cannot be read: {0}")]
    Description(#[from] roxmltree::Error),
    /// The flight of the documentation's picture could not be configured.
    #[error("the documentation's flight: {0}")]
    Configuration(#[from] ConfigurationError),
    /// The flight of the documentation's picture could not be flown.
    #[error("the documentation's flight: {0}")]
    Flight(#[from] SimulationError),
}
