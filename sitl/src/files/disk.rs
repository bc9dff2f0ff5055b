//! The folders of the disk that clients can reach, by their names in the root.

use std::path::{Path, PathBuf};

use autopilot::file_store::{Access, FileError, FileStore, LOGS, Listed, OpenFile};

use super::log_folder::LogFolder;
use super::mount::Mount;
use crate::failure::Failure;

/// Name of the folder that the user shares.
const FILES: &str = "files";

/// Up to two folders.
#[derive(Debug, Default)]
pub struct Disk {
    logs: Option<(Mount, LogFolder)>,
    files: Option<Mount>,
}

impl Disk {
    /// Shares the folder of logs, to be read, and one more, with whether it may be written.
    ///
    /// # Errors
    /// [`Failure::File`] when one is no folder.
    pub fn open(logs: Option<&LogFolder>, files: Option<&(PathBuf, bool)>) -> Result<Self, Failure> {
        let open =
            |path: &Path, writable| Mount::open(path, writable).map_err(|source| Failure::read(path, source));
        let logs = match logs {
            Some(folder) => Some((open(folder.path(), false)?, folder.clone())),
            None => None,
        };
        let files = files.map(|(path, writable)| open(path, *writable)).transpose()?;
        Ok(Self { logs, files })
    }

    /// The folder that a path is in, and the rest of the path.
    fn find<'a>(&self, path: &'a str) -> Result<(&Mount, &'a str), FileError> {
        let (name, rest) = path.split_once('/').unwrap_or((path, ""));
        // Whoever calls has checked; what is checked twice is checked.
        if rest.split('/').any(|name| matches!(name, "." | "..")) {
            return Err(FileError::NotFound);
        }
        let mount = match name {
            LOGS => self.logs.as_ref().map(|(mount, _)| mount),
            FILES => self.files.as_ref(),
            _ => None,
        };
        mount.map(|mount| (mount, rest)).ok_or(FileError::NotFound)
    }

    /// As [`Self::find`], of what is to be changed: never a folder of the root itself.
    fn find_below<'a>(&self, path: &'a str) -> Result<(&Mount, &'a str), FileError> {
        let (mount, rest) = self.find(path)?;
        if rest.is_empty() { Err(FileError::Protected) } else { Ok((mount, rest)) }
    }
}

impl FileStore for Disk {
    fn list(&self, path: &str) -> Result<Vec<Listed>, FileError> {
        if path.is_empty() {
            let folder = |name: &str| Listed { name: name.to_owned(), size: None, modified_unix_s: 0 };
            let files = self.files.iter().map(|_| folder(FILES));
            return Ok(files.chain(self.logs.iter().map(|_| folder(LOGS))).collect());
        }
        let (mount, rest) = self.find(path)?;
        mount.list(rest)
    }

    fn open(&mut self, path: &str, access: Access) -> Result<Box<dyn OpenFile>, FileError> {
        let (mount, rest) = self.find(path)?;
        if rest.is_empty() { Err(FileError::NotFound) } else { mount.open_file(rest, access) }
    }

    fn remove_file(&mut self, path: &str) -> Result<(), FileError> {
        let (mount, rest) = self.find_below(path)?;
        mount.remove_file(rest)
    }

    fn create_folder(&mut self, path: &str) -> Result<(), FileError> {
        let (mount, rest) = self.find_below(path)?;
        mount.create_folder(rest)
    }

    fn remove_folder(&mut self, path: &str) -> Result<(), FileError> {
        let (mount, rest) = self.find_below(path)?;
        mount.remove_folder(rest)
    }

    fn rename(&mut self, from: &str, to: &str) -> Result<(), FileError> {
        let ((one, from), (other, to)) = (self.find_below(from)?, self.find_below(to)?);
        // From one folder of the root into the other nothing moves.
        if std::ptr::eq(one, other) { one.rename(from, to) } else { Err(FileError::Protected) }
    }

    fn truncate(&mut self, path: &str, size: u64) -> Result<(), FileError> {
        let (mount, rest) = self.find_below(path)?;
        mount.truncate(rest, size)
    }

    fn erase_logs(&mut self) -> Result<(), FileError> {
        let Some((mount, folder)) = &self.logs else { return Ok(()) };
        let names: Vec<String> = mount.list("")?.into_iter().map(|listed| listed.name).collect();
        mount.erase(&names.into_iter().filter(|name| folder.is_over(name)).collect::<Vec<_>>())
    }
}
