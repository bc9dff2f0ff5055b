//! Reading and writing files, with the path in every error.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::failure::Failure;

/// Reads a file.
///
/// # Errors
///
/// If the file or folder cannot be accessed; the error names its path.
pub fn read(path: &Path) -> Result<Vec<u8>, Failure> {
    fs::read(path).map_err(failure("read", path))
}

/// Opens a file for reading.
///
/// # Errors
///
/// If the file or folder cannot be accessed; the error names its path.
pub fn open(path: &Path) -> Result<fs::File, Failure> {
    fs::File::open(path).map_err(failure("read", path))
}

/// Reads a text file.
///
/// # Errors
///
/// If the file or folder cannot be accessed; the error names its path.
pub fn read_text(path: &Path) -> Result<String, Failure> {
    fs::read_to_string(path).map_err(failure("read", path))
}

/// Writes a file and the folders that it lies in. Whoever reads it meanwhile sees the old one or the new
/// one, never a part.
///
/// # Errors
///
/// If the file or folder cannot be accessed; the error names its path.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    if let Some(folder) = path.parent() {
        create_folder(folder)?;
    }
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".new");
    let new = path.with_file_name(name);
    fs::write(&new, bytes).map_err(failure("write", &new))?;
    fs::rename(&new, path).map_err(failure("write", path))
}

/// Copies a file with its permissions over another, and returns how many bytes it has.
///
/// # Errors
///
/// If one of the files cannot be accessed; the error names the path of the copy.
pub fn copy(from: &Path, to: &Path) -> Result<u64, Failure> {
    fs::copy(from, to).map_err(failure("write", to))
}

/// Copies a folder with all that it holds, but for what is named in `without`.
///
/// # Errors
///
/// If one of the files or folders cannot be accessed; the error names its path.
pub fn copy_folder(from: &Path, to: &Path, without: &[&str]) -> Result<(), Failure> {
    create_folder(to)?;
    for path in names_in(from)? {
        let Some(name) = path.file_name() else { continue };
        if without.iter().any(|excluded| name == *excluded) {
            continue;
        }
        if path.is_dir() {
            copy_folder(&path, &to.join(name), without)?;
        } else {
            copy(&path, &to.join(name))?;
        }
    }
    Ok(())
}

/// Creates a folder with its parents.
///
/// # Errors
///
/// If the file or folder cannot be accessed; the error names its path.
pub fn create_folder(path: &Path) -> Result<(), Failure> {
    fs::create_dir_all(path).map_err(failure("create", path))
}

/// Removes a folder with all that it holds, if it exists.
///
/// # Errors
///
/// If the file or folder cannot be accessed; the error names its path.
pub fn remove_folder(path: &Path) -> Result<(), Failure> {
    match fs::remove_dir_all(path) {
        Err(source) if source.kind() != io::ErrorKind::NotFound => Err(failure("remove", path)(source)),
        _ => Ok(()),
    }
}

/// Names of the files in a folder, sorted.
///
/// # Errors
///
/// If the file or folder cannot be accessed; the error names its path.
pub fn names_in(path: &Path) -> Result<Vec<PathBuf>, Failure> {
    let entries = fs::read_dir(path).map_err(failure("list", path))?;
    let mut paths = entries
        .map(|entry| entry.map(|entry| entry.path()))
        .collect::<Result<Vec<_>, _>>()
        .map_err(failure("list", path))?;
    paths.sort();
    Ok(paths)
}

fn failure(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Failure {
    let path = path.to_owned();
    move |source| Failure::File { action, path, source }
}
