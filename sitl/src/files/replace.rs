//! Replacing the content of a file at once.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Who may read a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Readers {
    /// Whom the system lets.
    All,
    /// Its owner alone.
    Owner,
}

/// Writes a new file beside the old one and renames it: a reader never sees half of it, and a failure or crash leaves the old one.
/// The new file's temporary name is unique, so that two processes never write the same one.
///
/// # Errors
/// The error of the file system; the old file is unchanged.
pub fn replace(path: &Path, content: &[u8], readers: Readers) -> io::Result<()> {
    let path = resolved(path);
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let mut prefix = path.file_name().ok_or(io::ErrorKind::InvalidFilename)?.to_owned();
    prefix.push(".");
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).suffix(".new");
    limit(&mut builder, readers);
    let folder = folder.unwrap_or(Path::new("."));
    let mut file = builder.tempfile_in(folder).map_err(|error| unmade(folder, &error))?;
    file.write_all(content)?;
    file.persist(&path).map_err(|error| error.error)?;
    Ok(())
}

/// Why no file can be made in a folder. The library's error ends with the place of the file that was to take the other one's, which nobody
/// knows.
fn unmade(folder: &Path, error: &io::Error) -> io::Error {
    if let Err(of_folder) = std::fs::metadata(folder) {
        return of_folder;
    }
    let text = error.to_string();
    let reason = text.split(" at path ").next().unwrap_or_default();
    io::Error::new(error.kind(), reason.to_owned())
}

/// Lets the file's readers read it, and nobody else.
#[cfg(unix)]
fn limit(builder: &mut tempfile::Builder, readers: Readers) {
    use std::os::unix::fs::PermissionsExt;
    // The user's mask comes on top.
    let mode = if readers == Readers::Owner { 0o600 } else { 0o666 };
    builder.permissions(std::fs::Permissions::from_mode(mode));
}

/// Elsewhere a file has the rights of its folder.
#[cfg(not(unix))]
fn limit(_builder: &mut tempfile::Builder, _readers: Readers) {}

/// The file itself where a path is a link to one.
pub(super) fn resolved(path: &Path) -> PathBuf {
    std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
}

#[cfg(test)]
mod tests {
    use super::{Readers, replace};

    #[test]
    fn a_file_is_replaced_whole_or_not_at_all() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.params");
        replace(&path, b"one", Readers::All).expect("written");
        replace(&path, b"two", Readers::All).expect("written");
        assert_eq!(std::fs::read(&path).expect("there"), b"two");
        let refused = replace(&folder.path().join("no/such"), b"", Readers::All).expect_err("no folder");
        assert!(!refused.to_string().contains(".new"), "{refused}");
        assert!(replace(folder.path(), b"", Readers::All).is_err(), "a folder is no file");
        let names: Vec<_> = std::fs::read_dir(folder.path()).expect("a folder").collect();
        assert_eq!(names.len(), 1, "{names:?}");
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_a_link_and_modes_are_as_asked() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().expect("a folder");
        let (path, link) = (folder.path().join("a"), folder.path().join("link"));
        std::fs::write(&path, "old").expect("written");
        std::os::unix::fs::symlink(&path, &link).expect("a link");
        for (readers, most) in [(Readers::All, 0o666), (Readers::Owner, 0o600)] {
            replace(&link, b"new", readers).expect("written");
            assert!(link.is_symlink());
            let mode = path.metadata().expect("there").permissions().mode() & 0o777;
            assert_eq!((mode & !most, mode & 0o600), (0, 0o600), "{mode:o}");
        }
        assert_eq!(std::fs::read(&path).expect("there"), b"new");
    }
}
