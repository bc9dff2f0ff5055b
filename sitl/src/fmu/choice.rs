//! What `--fmu` and `--map` ask for.

use std::path::{Path, PathBuf};

use importer::Fmu;
use quadrotor::Configuration;

use super::map::Map;
use super::mapping::Mapping;
use crate::failure::Failure;

/// The argument that makes this program the host of an FMU.
pub const HOST_ARGUMENT: &str = "fmu-host";

/// An FMU that is to fly, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct FmuChoice {
    /// The file.
    pub path: PathBuf,
    /// Its map.
    pub map: Map,
    /// The program that hosts it.
    pub host: PathBuf,
}

impl FmuChoice {
    /// An FMU with the map of a file, or that of our names, hosted by this program.
    ///
    /// # Errors
    /// [`Failure`] of the map.
    pub fn new(path: &Path, map: Option<&Path>) -> Result<Self, Failure> {
        let host =
            std::env::current_exe().map_err(|source| Failure::read(Path::new("/proc/self/exe"), source))?;
        Ok(Self { path: path.to_owned(), map: map.map(Map::read).transpose()?.unwrap_or_default(), host })
    }

    /// Opens the FMU and finds its variables, for a vehicle with a configuration.
    ///
    /// # Errors
    /// [`Failure::Content`] with what is wrong with the FMU, or does not fit.
    pub fn open(&self, configuration: &Configuration) -> Result<(Fmu, Mapping), Failure> {
        let wrong = |reason: String| Failure::Content { path: self.path.clone(), reason };
        let fmu = Fmu::open(&self.path).map_err(|error| wrong(error.to_string()))?;
        fmu.library().map_err(|error| wrong(error.to_string()))?;
        let mapping = Mapping::new(&self.map, fmu.description(), configuration).map_err(wrong)?;
        Ok((fmu, mapping))
    }
}
