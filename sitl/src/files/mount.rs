//! One folder of the disk, and the files below it.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::UNIX_EPOCH;

use autopilot::file_store::{Access, FileError, Listed, OpenFile};
use cap_std::ambient_authority;
use cap_std::fs::{Dir, File, OpenOptions};

use super::usage::{ENTRY, LARGEST_FILE, Usage};

/// Folders within folders that a client may make.
const DEEPEST: usize = 32;
/// Bytes of a name that a client may give.
const LONGEST_NAME: usize = 128;

/// A folder. Links that lead out of it, devices and pipes are not there for whoever asks.
#[derive(Debug)]
pub struct Mount {
    folder: Dir,
    writable: bool,
    usage: Usage,
}

/// An open file of a folder.
#[derive(Debug)]
struct MountedFile {
    file: Arc<File>,
    /// The folder and what is used of it, if the file may be written.
    grows: Option<(Dir, Usage)>,
}

impl Mount {
    /// Opens a folder.
    ///
    /// # Errors
    /// When it is no folder that can be read.
    pub fn open(path: &Path, writable: bool) -> io::Result<Self> {
        let folder = Dir::open_ambient_dir(path, ambient_authority())?;
        Ok(Self { folder, writable, usage: Usage::default() })
    }

    /// What is in a folder, by name.
    pub(super) fn list(&self, path: &str) -> Result<Vec<Listed>, FileError> {
        let entries = if path.is_empty() { self.folder.entries() } else { self.folder.read_dir(path) };
        let mut listed: Vec<Listed> = entries
            .map_err(meaning)?
            .flatten()
            .filter_map(|entry| {
                let name = entry.file_name().into_string().ok()?;
                let path = if path.is_empty() { name.clone() } else { format!("{path}/{name}") };
                // Follows a link as far as it may be followed.
                let metadata = self.folder.metadata(path).ok()?;
                let size = match metadata.file_type() {
                    kind if kind.is_dir() => None,
                    kind if kind.is_file() => Some(metadata.len()),
                    _ => return None,
                };
                let modified = metadata.modified().ok().map(cap_std::time::SystemTime::into_std);
                let since_1970 = modified.and_then(|time| time.duration_since(UNIX_EPOCH).ok());
                Some(Listed { name, size, modified_unix_s: since_1970.unwrap_or_default().as_secs() })
            })
            .collect();
        listed.sort_by(|one, other| one.name.cmp(&other.name));
        Ok(listed)
    }

    pub(super) fn open_file(&self, path: &str, access: Access) -> Result<Box<dyn OpenFile>, FileError> {
        let mut options = OpenOptions::new();
        let is_new = access != Access::Read && !self.folder.exists(path);
        if access == Access::Read {
            options.read(true);
        } else {
            self.check_name(path)?;
            if is_new {
                self.usage.grow(&self.folder, ENTRY)?;
            }
            options.read(true).write(true).create(true);
        }
        #[cfg(unix)]
        {
            use cap_std::fs::OpenOptionsExt;
            // A pipe that nobody writes to must not keep others waiting.
            options.custom_flags(rustix::fs::OFlags::NONBLOCK.bits() as i32);
        }
        let file = self.folder.open_with(path, &options).map_err(meaning).inspect_err(|_| {
            if is_new {
                self.usage.shrink(ENTRY);
            }
        })?;
        let metadata = file.metadata().map_err(meaning)?;
        if !metadata.is_file() {
            return Err(FileError::NotFound);
        }
        if access == Access::Create {
            file.set_len(0).map_err(meaning)?;
            self.usage.shrink(metadata.len());
        }
        let file = Arc::new(file);
        self.usage.watch(&file);
        let grows = match access {
            Access::Read => None,
            _ => Some((self.folder.try_clone().map_err(meaning)?, self.usage.clone())),
        };
        Ok(Box::new(MountedFile { file, grows }))
    }

    fn check_writable(&self) -> Result<(), FileError> {
        if self.writable { Ok(()) } else { Err(FileError::Protected) }
    }

    /// Whether a path may be given to something.
    fn check_name(&self, path: &str) -> Result<(), FileError> {
        self.check_writable()?;
        let name = path.rsplit('/').next().unwrap_or_default();
        let deep = path.split('/').count() > DEEPEST;
        if name.is_empty() || name.len() > LONGEST_NAME || name.chars().any(char::is_control) || deep {
            Err(FileError::Failed)
        } else {
            Ok(())
        }
    }

    pub(super) fn remove_file(&self, path: &str) -> Result<(), FileError> {
        self.check_writable()?;
        let metadata = self.folder.symlink_metadata(path).map_err(meaning)?;
        self.folder.remove_file(path).map_err(meaning)?;
        let bytes = if metadata.is_file() { metadata.len() } else { 0 };
        self.usage.shrink(ENTRY + bytes);
        Ok(())
    }

    pub(super) fn create_folder(&self, path: &str) -> Result<(), FileError> {
        self.check_name(path)?;
        self.usage.grow(&self.folder, ENTRY)?;
        self.folder.create_dir(path).map_err(meaning).inspect_err(|_| self.usage.shrink(ENTRY))
    }

    pub(super) fn remove_folder(&self, path: &str) -> Result<(), FileError> {
        self.check_writable()?;
        self.folder.remove_dir(path).map_err(meaning)?;
        self.usage.shrink(ENTRY);
        Ok(())
    }

    pub(super) fn rename(&self, from: &str, to: &str) -> Result<(), FileError> {
        self.check_name(to)?;
        if self.folder.symlink_metadata(to).is_ok() {
            return Err(FileError::Exists);
        }
        // What is below a folder goes deeper with it.
        let room = DEEPEST.saturating_sub(to.split('/').count());
        let moved = self.folder.symlink_metadata(from).map_err(meaning)?;
        if moved.is_dir() && is_deeper(&self.folder, from, room) {
            return Err(FileError::Failed);
        }
        self.folder.rename(from, &self.folder, to).map_err(meaning)
    }

    pub(super) fn truncate(&self, path: &str, size: u64) -> Result<(), FileError> {
        self.check_writable()?;
        let metadata = self.folder.metadata(path).map_err(meaning)?;
        if !metadata.is_file() {
            return Err(FileError::NotFound);
        }
        if size > LARGEST_FILE {
            return Err(FileError::NoSpace);
        }
        let mut options = OpenOptions::new();
        options.write(true);
        let file = self.folder.open_with(path, &options).map_err(meaning)?;
        let growth = size.saturating_sub(metadata.len());
        if growth > 0 {
            self.usage.grow(&self.folder, growth)?;
        }
        file.set_len(size).map_err(meaning).inspect_err(|_| self.usage.shrink(growth))?;
        self.usage.shrink(metadata.len().saturating_sub(size));
        Ok(())
    }

    /// Removes the files that have one of some names, whoever may write here.
    pub(super) fn erase(&self, names: &[String]) -> Result<(), FileError> {
        names.iter().try_for_each(|name| self.folder.remove_file(name).map_err(meaning))
    }
}

impl OpenFile for MountedFile {
    fn size(&self) -> Result<u64, FileError> {
        Ok(self.file.metadata().map_err(meaning)?.len())
    }

    fn read_at(&mut self, offset: u64, into: &mut [u8]) -> Result<usize, FileError> {
        use std::io::{Read, Seek, SeekFrom};
        let mut file = self.file.as_ref();
        file.seek(SeekFrom::Start(offset)).map_err(meaning)?;
        let mut read = 0;
        while let Some(rest) = into.get_mut(read..).filter(|rest| !rest.is_empty()) {
            match file.read(rest) {
                Ok(0) => break,
                Ok(length) => read += length,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(meaning(error)),
            }
        }
        Ok(read)
    }

    fn write_at(&mut self, offset: u64, bytes: &[u8]) -> Result<(), FileError> {
        use std::io::{Seek, SeekFrom, Write};
        let (folder, usage) = self.grows.as_ref().ok_or(FileError::Protected)?;
        let size = self.size()?;
        let end = offset.saturating_add(bytes.len() as u64);
        if end > LARGEST_FILE {
            return Err(FileError::NoSpace);
        }
        if end > size {
            usage.grow_file(folder, &self.file, end - size)?;
        }
        let mut file = self.file.as_ref();
        file.seek(SeekFrom::Start(offset)).map_err(meaning)?;
        file.write_all(bytes).map_err(meaning)
    }
}

/// Whether there are folders within folders below a folder, more than so many of them.
fn is_deeper(folder: &Dir, path: &str, most: usize) -> bool {
    let mut folders = vec![(PathBuf::from(path), most)];
    while let Some((path, most)) = folders.pop() {
        let Ok(entries) = folder.read_dir(&path) else { continue };
        for entry in entries.flatten() {
            match (most.checked_sub(1), entry.file_type()) {
                (None, _) => return true,
                (Some(most), Ok(kind)) if kind.is_dir() => folders.push((path.join(entry.file_name()), most)),
                _ => {}
            }
        }
    }
    false
}

/// What a client needs to know of an error. What may not be reached is not told apart from what is not there.
fn meaning(error: io::Error) -> FileError {
    match error.kind() {
        io::ErrorKind::NotFound
        | io::ErrorKind::PermissionDenied
        | io::ErrorKind::NotADirectory
        | io::ErrorKind::IsADirectory
        | io::ErrorKind::InvalidFilename => FileError::NotFound,
        io::ErrorKind::AlreadyExists | io::ErrorKind::DirectoryNotEmpty => FileError::Exists,
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => FileError::NoSpace,
        io::ErrorKind::ReadOnlyFilesystem => FileError::Protected,
        _ => FileError::Failed,
    }
}
