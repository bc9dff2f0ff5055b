//! One folder of the disk, and the files below it.

use std::io;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::UNIX_EPOCH;

use autopilot::file_store::{Access, FileError, Listed, OpenFile};
use cap_std::ambient_authority;
use cap_std::fs::{Dir, File, OpenOptions};

/// Bytes of the largest file that a client may write.
const LARGEST_FILE: u64 = 16 << 20;
/// Bytes of all files together.
const QUOTA: u64 = 64 << 20;
/// Files and folders; each is counted as this many bytes, too.
const ENTRY: u64 = 4096;
/// Folders within folders that are counted.
const DEEPEST: usize = 32;
/// Bytes of a name that a client may give.
const LONGEST_NAME: usize = 128;

/// A folder. Links that lead out of it, devices and pipes are not there for whoever asks.
#[derive(Debug)]
pub struct Mount {
    folder: Dir,
    writable: bool,
    used: Arc<AtomicU64>,
}

/// An open file of a folder.
#[derive(Debug)]
struct MountedFile {
    file: File,
    writable: bool,
    used: Arc<AtomicU64>,
}

impl Mount {
    /// Opens a folder.
    ///
    /// # Errors
    /// When it is no folder that can be read.
    pub fn open(path: &Path, writable: bool) -> io::Result<Self> {
        let folder = Dir::open_ambient_dir(path, ambient_authority())?;
        let mount = Self { folder, writable, used: Arc::default() };
        mount.count();
        Ok(mount)
    }

    /// Counts what is there.
    fn count(&self) {
        if self.writable {
            self.used.store(bytes_in(&self.folder, DEEPEST), Ordering::Relaxed);
        }
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
        match access {
            Access::Read => options.read(true),
            Access::Create | Access::Write => {
                self.check_new(path)?;
                options.read(true).write(true).create(true)
            }
        };
        #[cfg(unix)]
        {
            use cap_std::fs::OpenOptionsExt;
            // A pipe that nobody writes to must not keep the vehicle from flying.
            options.custom_flags(rustix::fs::OFlags::NONBLOCK.bits() as i32);
        }
        let file = self.folder.open_with(path, &options).map_err(meaning)?;
        if !file.metadata().map_err(meaning)?.is_file() {
            return Err(FileError::NotFound);
        }
        if access == Access::Create {
            file.set_len(0).map_err(meaning)?;
        }
        if access != Access::Read {
            self.count();
        }
        Ok(Box::new(MountedFile { file, writable: access != Access::Read, used: Arc::clone(&self.used) }))
    }

    /// Whether a path may be written.
    fn check_new(&self, path: &str) -> Result<(), FileError> {
        let name = path.rsplit('/').next().unwrap_or_default();
        if !self.writable {
            Err(FileError::Protected)
        } else if name.is_empty() || name.len() > LONGEST_NAME || name.chars().any(char::is_control) {
            Err(FileError::Failed)
        } else if !self.folder.exists(path) && self.used.load(Ordering::Relaxed) + ENTRY > QUOTA {
            Err(FileError::NoSpace)
        } else {
            Ok(())
        }
    }

    /// Does something to what is there.
    fn change(&self, work: impl FnOnce(&Dir) -> io::Result<()>) -> Result<(), FileError> {
        if !self.writable {
            return Err(FileError::Protected);
        }
        let result = work(&self.folder).map_err(meaning);
        self.count();
        result
    }

    pub(super) fn remove_file(&self, path: &str) -> Result<(), FileError> {
        self.change(|folder| folder.remove_file(path))
    }

    pub(super) fn create_folder(&self, path: &str) -> Result<(), FileError> {
        self.check_new(path)?;
        self.change(|folder| folder.create_dir(path))
    }

    pub(super) fn remove_folder(&self, path: &str) -> Result<(), FileError> {
        self.change(|folder| folder.remove_dir(path))
    }

    pub(super) fn rename(&self, from: &str, to: &str) -> Result<(), FileError> {
        self.check_new(to)?;
        if self.folder.symlink_metadata(to).is_ok() {
            return Err(FileError::Exists);
        }
        self.change(|folder| folder.rename(from, folder, to))
    }

    pub(super) fn truncate(&self, path: &str, size: u64) -> Result<(), FileError> {
        if !self.writable {
            return Err(FileError::Protected);
        }
        let metadata = self.folder.metadata(path).map_err(meaning)?;
        if !metadata.is_file() {
            return Err(FileError::NotFound);
        }
        reserve(&self.used, metadata.len(), size)?;
        let mut options = OpenOptions::new();
        options.write(true);
        self.change(|folder| folder.open_with(path, &options)?.set_len(size))
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
        self.file.seek(SeekFrom::Start(offset)).map_err(meaning)?;
        let mut read = 0;
        while let Some(rest) = into.get_mut(read..).filter(|rest| !rest.is_empty()) {
            match self.file.read(rest) {
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
        if !self.writable {
            return Err(FileError::Protected);
        }
        let size = self.size()?;
        reserve(&self.used, size, size.max(offset.saturating_add(bytes.len() as u64)))?;
        self.file.seek(SeekFrom::Start(offset)).map_err(meaning)?;
        self.file.write_all(bytes).map_err(meaning)
    }
}

/// Counts the growth of a file, if there is room for it.
fn reserve(used: &AtomicU64, size: u64, wanted: u64) -> Result<(), FileError> {
    let growth = wanted.saturating_sub(size);
    if wanted > LARGEST_FILE || used.load(Ordering::Relaxed).saturating_add(growth) > QUOTA {
        return Err(FileError::NoSpace);
    }
    used.fetch_add(growth, Ordering::Relaxed);
    Ok(())
}

/// Links are not followed: what they lead to is counted where it is.
fn bytes_in(folder: &Dir, depth: usize) -> u64 {
    let Ok(entries) = folder.entries() else { return 0 };
    let of = |entry: cap_std::fs::DirEntry| {
        let below = match entry.file_type() {
            Ok(kind) if kind.is_dir() && depth > 0 => {
                entry.open_dir().map_or(0, |below| bytes_in(&below, depth - 1))
            }
            Ok(kind) if kind.is_file() => entry.metadata().map_or(0, |metadata| metadata.len()),
            _ => 0,
        };
        ENTRY + below
    };
    entries.flatten().map(of).fold(0, u64::saturating_add)
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
