//! What can be wrong with an FMU, and with a call of it.

use std::io;

use crate::fmi2::{Call, Status};

/// Why a file cannot be used as an FMU. Messages do not name the file.
#[derive(Debug, thiserror::Error)]
pub enum ImportError {
    /// The file, or the folder that it is unpacked into.
    #[error("cannot be read or unpacked: {0}")]
    File(#[from] io::Error),
    /// It is not a readable archive.
    #[error("is not an FMU: {0}; an FMU is a zip archive with modelDescription.xml in it")]
    Archive(String),
    /// An entry that would leave the folder, or is too large.
    #[error("the archive is refused: {0}")]
    Refused(String),
    /// The model description.
    #[error("modelDescription.xml: {0}")]
    Description(String),
    /// It is of another version of the standard.
    #[error("is an FMU of FMI {0}; only FMI 2.0 co-simulation is supported")]
    Version(String),
    /// It has no co-simulation.
    #[error(
        "has no co-simulation (its modelDescription.xml lacks <CoSimulation>); export it as FMI 2.0 co-simulation"
    )]
    NotCoSimulation,
    /// No library for this platform.
    #[error("has no library for this platform: {wanted} is missing, the archive has {present}")]
    Platform {
        /// What was looked for.
        wanted: String,
        /// Folders in `binaries`.
        present: String,
    },
    /// The library cannot be loaded.
    #[error("its library cannot be loaded: {0}")]
    Library(String),
    /// The library lacks a function.
    #[error("its library lacks the function {0} of FMI 2.0 co-simulation")]
    Function(&'static str),
    /// The library is of another version of the standard.
    #[error("its library says that it is of FMI {0}, its modelDescription.xml 2.0")]
    LibraryVersion(String),
    /// fmi2Instantiate returned nothing.
    #[error(
        "fmi2Instantiate made no instance; if the FMU does not say why, its library may be of another export than its modelDescription.xml (guid)"
    )]
    Instantiate,
    /// A text with a zero character.
    #[error("a text for the FMU has a zero character in it: {0:?}")]
    Text(String),
}

/// A call that failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{call} returned {status}")]
pub struct CallError {
    /// Which one.
    pub call: Call,
    /// What it returned.
    pub status: Status,
}
