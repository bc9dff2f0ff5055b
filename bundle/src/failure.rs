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
    /// The model's own description is not XML.
    #[error("modelDescription.xml cannot be read: {0}")]
    Description(#[from] roxmltree::Error),
    /// A document of the system could not be written.
    #[error("the documents of the SSP archive: {0}")]
    Document(std::io::Error),
    /// The flight of the documentation's picture could not be configured.
    #[error("the documentation's flight: {0}")]
    Configuration(#[from] ConfigurationError),
    /// The flight of the documentation's picture could not be flown.
    #[error("the documentation's flight: {0}")]
    Flight(#[from] SimulationError),
}
