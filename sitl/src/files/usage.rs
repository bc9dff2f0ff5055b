//! How much of a folder's quota is used.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::{Duration, Instant};

use autopilot::file_store::FileError;
use cap_std::fs::{Dir, File};

/// Bytes of the largest file that a client may write.
pub const LARGEST_FILE: u64 = 16 << 20;
/// Bytes of all files together.
pub const QUOTA: u64 = 64 << 20;
/// Files and folders: each is counted as this many bytes, too.
pub const ENTRY: u64 = 4096;
/// Others may change the folder, so it is counted again before something grows after this time.
const RECOUNT: Duration = Duration::from_millis(250);

/// What is used, shared between a folder and its open files.
#[derive(Clone, Debug, Default)]
pub struct Usage(Arc<Mutex<Count>>);

#[derive(Debug, Default)]
struct Count {
    /// Bytes of what has a name.
    named: u64,
    counted: Option<Instant>,
    /// Files that clients have open: without a name they still take their place on the disk.
    open: Vec<Weak<File>>,
}

impl Usage {
    fn lock(&self) -> MutexGuard<'_, Count> {
        // It is a number and a list, as good as before whoever has panicked with it.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Remembers an open file.
    pub fn watch(&self, file: &Arc<File>) {
        let mut count = self.lock();
        count.open.retain(|open| open.strong_count() > 0);
        count.open.push(Arc::downgrade(file));
    }

    /// Bytes that are used, as far as is known.
    fn used(&self) -> u64 {
        let count = self.lock();
        // A file may be open more than once.
        let unnamed: BTreeMap<_, _> =
            count.open.iter().filter_map(Weak::upgrade).filter_map(|file| unnamed(&file)).collect();
        unnamed.values().fold(count.named, |sum, bytes| sum.saturating_add(*bytes))
    }

    /// Counts the growth of something, if there is room for it.
    pub fn grow(&self, folder: &Dir, bytes: u64) -> Result<(), FileError> {
        self.check(folder, bytes)?;
        let mut count = self.lock();
        count.named = count.named.saturating_add(bytes);
        Ok(())
    }

    /// As [`Self::grow`], of an open file.
    pub fn grow_file(&self, folder: &Dir, file: &File, bytes: u64) -> Result<(), FileError> {
        // Without a name it is not counted here, but measured each time.
        if unnamed(file).is_some() { self.check(folder, bytes) } else { self.grow(folder, bytes) }
    }

    /// Whether there is room.
    fn check(&self, folder: &Dir, bytes: u64) -> Result<(), FileError> {
        if self.lock().counted.is_none_or(|counted| counted.elapsed() >= RECOUNT) {
            self.recount(folder);
        }
        if self.used().saturating_add(bytes) > QUOTA { Err(FileError::NoSpace) } else { Ok(()) }
    }

    /// Something was removed.
    pub fn shrink(&self, bytes: u64) {
        let mut count = self.lock();
        count.named = count.named.saturating_sub(bytes);
    }

    /// Looks at what there is.
    fn recount(&self, folder: &Dir) {
        let named = named(folder);
        let mut count = self.lock();
        (count.named, count.counted) = (named, Some(Instant::now()));
    }
}

/// Bytes of everything in a folder at any depth, until it is more than the quota. Links are not followed: what they lead to is counted
/// where it is.
fn named(folder: &Dir) -> u64 {
    let mut bytes = 0_u64;
    let mut folders = vec![PathBuf::from(".")];
    while let Some(path) = folders.pop() {
        // What cannot be read cannot be written, either.
        let Ok(entries) = folder.read_dir(&path) else { continue };
        for entry in entries.flatten() {
            bytes = bytes.saturating_add(ENTRY);
            match entry.file_type() {
                Ok(kind) if kind.is_dir() => folders.push(path.join(entry.file_name())),
                Ok(kind) if kind.is_file() => {
                    bytes = bytes.saturating_add(entry.metadata().map_or(0, |metadata| metadata.len()));
                }
                _ => {}
            }
            if bytes > QUOTA {
                return bytes;
            }
        }
    }
    bytes
}

/// Bytes of a file that is open and has no name any more, with the numbers of its device and of itself.
#[cfg(unix)]
fn unnamed(file: &File) -> Option<((u64, u64), u64)> {
    use cap_std::fs::MetadataExt;
    let metadata = file.metadata().ok().filter(|metadata| metadata.nlink() == 0)?;
    Some(((metadata.dev(), metadata.ino()), ENTRY + metadata.len()))
}

/// Elsewhere files keep their names while they are open.
#[cfg(not(unix))]
fn unnamed(_file: &File) -> Option<((u64, u64), u64)> {
    None
}
