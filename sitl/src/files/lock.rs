//! One process at a time writes a file.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use super::replace::resolved;
use super::upkeep::reason;
use crate::failure::Failure;

/// How often a lock file may vanish while it is being locked.
const ATTEMPTS: usize = 100;

/// The right to write a file, held until it is dropped: a lock on `NAME.lock` beside it, because the file itself may be replaced.
/// The system releases the lock when the process ends, however it ends.
#[derive(Debug)]
pub struct FileLock {
    path: PathBuf,
    /// Holds the lock while it is open.
    _file: File,
}

impl FileLock {
    /// Locks a file that this process is going to write. `None` where a lock is impossible, on a read-only disk for example: that is
    /// logged, and does not keep anybody from flying.
    ///
    /// # Errors
    /// [`Failure::Content`] if another process has the file, [`Failure::File`] if there is no folder for it.
    pub fn claim(file: &Path) -> Result<Option<Self>, Failure> {
        let file = resolved(file);
        if std::fs::metadata(&file).is_ok_and(|metadata| !metadata.is_file()) {
            // Devices and pipes have no neighbours of ours.
            return Ok(None);
        }
        let mut path = file.clone().into_os_string();
        path.push(".lock");
        let path = PathBuf::from(path);
        match lock(&path) {
            Ok(Ok(locked)) => Ok(Some(Self { path, _file: locked })),
            Ok(Err(owner)) => {
                let reason = format!("is in use by {owner}; give each process a file of its own");
                Err(Failure::Content { path: file, reason })
            }
            Err(error) if error.kind() == io::ErrorKind::NotFound => Err(Failure::write(&file, error)),
            Err(error) => {
                tracing::warn!(
                    "{} is not protected from other processes: {}",
                    file.display(),
                    reason(&error)
                );
                Ok(None)
            }
        }
    }
}

/// The locked file, or a description of who has locked it.
fn lock(path: &Path) -> io::Result<Result<File, String>> {
    for _ in 0..ATTEMPTS {
        let mut file = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Ok(Err(owner(&mut file))),
            Err(TryLockError::Error(error)) => return Err(error),
        }
        // Its former owner may have removed it between the two calls.
        if is_at(&file, path)? {
            // The number is only told to people; the lock counts.
            let _unwritten = file.set_len(0).and_then(|()| write!(file, "{}", std::process::id()));
            return Ok(Ok(file));
        }
    }
    Err(io::ErrorKind::ResourceBusy.into())
}

fn owner(file: &mut File) -> String {
    let mut text = String::new();
    match file.read_to_string(&mut text).ok().and_then(|_| text.trim().parse::<u32>().ok()) {
        Some(id) if id == std::process::id() => "this process already".to_owned(),
        Some(id) => format!("process {id}"),
        None => "another process".to_owned(),
    }
}

/// Whether an open file is the one of a path.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> io::Result<bool> {
    use std::os::unix::fs::MetadataExt;
    let opened = file.metadata()?;
    match std::fs::metadata(path) {
        Ok(found) => Ok((found.dev(), found.ino()) == (opened.dev(), opened.ino())),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
        Err(error) => Err(error),
    }
}

/// Elsewhere nobody removes lock files.
#[cfg(not(unix))]
fn is_at(_file: &File, _path: &Path) -> io::Result<bool> {
    Ok(true)
}

impl Drop for FileLock {
    fn drop(&mut self) {
        if cfg!(unix) {
            // While it is still locked: whoever opens it now notices that it is gone.
            let _gone = std::fs::remove_file(&self.path);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::FileLock;

    #[test]
    fn a_second_claim_is_refused_until_the_first_is_dropped() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.params");
        let first = FileLock::claim(&path).expect("free").expect("locked");
        let text = FileLock::claim(&path).expect_err("taken").to_string();
        assert!(text.contains("a.params: is in use by this process already"), "{text}");
        assert!(FileLock::claim(&folder.path().join("b.params")).expect("free").is_some());
        drop(first);
        assert!(FileLock::claim(&path).expect("free").is_some());
        assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), 0, "locks are left behind");
        assert!(FileLock::claim(&folder.path().join("no/such.params")).is_err());
    }

    /// A link to a file is the file.
    #[cfg(unix)]
    #[test]
    fn links_lead_to_the_same_lock_and_devices_have_none() {
        let folder = tempfile::tempdir().expect("a folder");
        let (path, link) = (folder.path().join("a.params"), folder.path().join("link"));
        std::fs::write(&path, "").expect("written");
        std::os::unix::fs::symlink(&path, &link).expect("a link");
        let _first = FileLock::claim(&path).expect("free").expect("locked");
        assert!(FileLock::claim(&link).is_err());
        assert!(FileLock::claim(std::path::Path::new("/dev/null")).expect("a device").is_none());
    }

    /// Lock files that come and go never let two in.
    #[test]
    fn at_most_one_of_many_threads_holds_it() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.params");
        let (inside, entered) = (AtomicUsize::new(0), AtomicUsize::new(0));
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    for _ in 0..500 {
                        if let Ok(Some(lock)) = FileLock::claim(&path) {
                            assert_eq!(inside.fetch_add(1, Ordering::SeqCst), 0);
                            entered.fetch_add(1, Ordering::SeqCst);
                            inside.fetch_sub(1, Ordering::SeqCst);
                            drop(lock);
                        }
                    }
                });
            }
        });
        assert!(entered.load(Ordering::SeqCst) > 4);
    }
}
