//! An FMU file.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use crate::archive::unpack;
use crate::description::ModelDescription;
use crate::error::ImportError;
use crate::fmi2::{Birth, Call, Instance, Message};
use crate::platform;

/// Bytes of the longest description.
const LONGEST_DESCRIPTION: u64 = 512 << 20;

/// An FMU of FMI 2.0 for co-simulation, unpacked into a temporary folder that goes with the value.
#[derive(Debug)]
pub struct Fmu {
    folder: TempDir,
    description: ModelDescription,
}

impl Fmu {
    /// Unpacks a file and reads its description.
    ///
    /// # Errors
    /// [`ImportError`]; none of it names the file.
    pub fn open(path: &Path) -> Result<Self, ImportError> {
        let folder = unpack(path)?;
        let file = folder.path().join("modelDescription.xml");
        if !file.is_file() {
            return Err(ImportError::Archive("modelDescription.xml is missing".to_owned()));
        }
        let mut bytes = Vec::new();
        fs::File::open(file)?.take(LONGEST_DESCRIPTION + 1).read_to_end(&mut bytes)?;
        if bytes.len() as u64 > LONGEST_DESCRIPTION {
            return Err(ImportError::Refused("modelDescription.xml is larger than 512 MiB".to_owned()));
        }
        let text =
            String::from_utf8(bytes).map_err(|_| ImportError::Description("is not UTF-8 text".to_owned()))?;
        let description = ModelDescription::parse(text.trim_start_matches('\u{feff}'))?;
        Ok(Self { folder, description })
    }

    /// What it says of itself.
    pub fn description(&self) -> &ModelDescription {
        &self.description
    }

    /// Its library for this platform.
    ///
    /// # Errors
    /// [`ImportError::Platform`]
    pub fn library(&self) -> Result<PathBuf, ImportError> {
        platform::library(self.folder.path(), &self.description.model_identifier)
    }

    /// Where its files are.
    pub(crate) fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// URI of its resources.
    pub(crate) fn resources(&self) -> String {
        file_uri(&self.folder.path().join("resources"))
    }

    /// Makes an instance in this process, which runs the FMU's code: see [`Guarded`](crate::Guarded) for those that may crash.
    /// `take` receives what it logs.
    ///
    /// # Errors
    /// [`ImportError`]
    pub fn instantiate(
        &self,
        name: &str,
        take: impl FnMut(Message) + Send + 'static,
    ) -> Result<Instance, ImportError> {
        let (library, resources) = (self.library()?, self.resources());
        let guid = &self.description.guid;
        let birth = Birth { library: &library, guid, resources: &resources, name, debug: false };
        Instance::new(&birth, take, Box::new(|_: Call| {}))
    }
}

/// The URI of a file: RFC 8089.
fn file_uri(path: &Path) -> String {
    let text = path.to_string_lossy().replace('\\', "/");
    let mut uri = String::from(if text.starts_with('/') { "file://" } else { "file:///" });
    for byte in text.bytes() {
        if byte.is_ascii_alphanumeric() || b"/-._~:".contains(&byte) {
            uri.push(char::from(byte));
        } else {
            uri.push_str(&format!("%{byte:02X}"));
        }
    }
    uri
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::file_uri;

    #[test]
    fn uris_have_no_characters_that_they_may_not_have() {
        assert_eq!(file_uri(Path::new("/tmp/fmu-1/resources")), "file:///tmp/fmu-1/resources");
        assert_eq!(file_uri(Path::new("/a b/ü%")), "file:///a%20b/%C3%BC%25");
        assert_eq!(file_uri(Path::new("C:\\Temp\\x")), "file:///C:/Temp/x");
    }
}
