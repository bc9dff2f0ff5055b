//! A file of ours with another content.

use std::fs::OpenOptions;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::failure::Failure;

/// Who may read a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Readers {
    /// Whom the system lets.
    All,
    /// Its owner alone.
    Owner,
}

/// Writes a file beside the old one and puts it in its place: a reader never sees half of it, and a crash in between leaves the
/// old one.
///
/// # Errors
/// [`Failure::File`]
pub fn replace(path: &Path, content: &[u8], readers: Readers) -> Result<(), Failure> {
    write(path, content, readers).map_err(|source| Failure::write(path, source))
}

fn write(path: &Path, content: &[u8], readers: Readers) -> io::Result<()> {
    let mut beside = path.to_owned().into_os_string();
    beside.push(".new");
    let beside = PathBuf::from(beside);
    // What a crash has left behind may have another mode.
    match std::fs::remove_file(&beside) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
        _ => {}
    }
    let mut options = OpenOptions::new();
    options.write(true).create_new(true);
    #[cfg(unix)]
    if readers == Readers::Owner {
        use std::os::unix::fs::OpenOptionsExt;
        options.mode(0o600);
    }
    options.open(&beside)?.write_all(content)?;
    std::fs::rename(&beside, path)
}
