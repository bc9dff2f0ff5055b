//! The library for this platform.

use std::env::consts::DLL_EXTENSION;
use std::fs;
use std::path::{Path, PathBuf};

use crate::error::ImportError;

/// Folders in `binaries` that this platform's library can be in, the standard's first. FMI 2.0 names none for processors other
/// than x86; exporters take the names of FMI 3.0 or their own.
const FOLDERS: &[&str] = {
    if cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        &["linux64", "x86_64-linux"]
    } else if cfg!(all(target_os = "linux", target_arch = "x86")) {
        &["linux32", "x86-linux"]
    } else if cfg!(all(target_os = "linux", target_arch = "aarch64")) {
        &["aarch64-linux", "linux-aarch64", "linuxaarch64", "linux64-aarch64"]
    } else if cfg!(all(windows, target_arch = "x86_64")) {
        &["win64", "x86_64-windows"]
    } else if cfg!(all(windows, target_arch = "x86")) {
        &["win32", "x86-windows"]
    } else if cfg!(all(target_os = "macos", target_arch = "aarch64")) {
        &["aarch64-darwin", "darwin64"]
    } else if cfg!(all(target_os = "macos", target_arch = "x86_64")) {
        &["darwin64", "x86_64-darwin"]
    } else {
        &[]
    }
};

/// The library of an unpacked FMU.
///
/// # Errors
/// [`ImportError::Platform`] with the platforms that there are.
pub(crate) fn library(folder: &Path, identifier: &str) -> Result<PathBuf, ImportError> {
    let binaries = folder.join("binaries");
    let file = format!("{identifier}.{DLL_EXTENSION}");
    let found =
        FOLDERS.iter().map(|platform| binaries.join(platform).join(&file)).find(|path| path.is_file());
    found.ok_or_else(|| {
        let entries = fs::read_dir(&binaries).into_iter().flatten().flatten();
        let mut present: Vec<String> = entries
            .filter(|entry| entry.path().is_dir())
            .map(|entry| entry.file_name().to_string_lossy().into_owned())
            .collect();
        present.sort();
        let first = FOLDERS.first().copied().unwrap_or(std::env::consts::ARCH);
        ImportError::Platform {
            wanted: format!("binaries/{first}/{file}"),
            present: if present.is_empty() { "no binaries".to_owned() } else { present.join(", ") },
        }
    })
}

#[cfg(all(test, target_os = "linux", target_arch = "x86_64"))]
mod tests {
    use super::library;

    #[test]
    fn a_missing_platform_is_named_with_those_that_there_are() {
        let folder = tempfile::tempdir().expect("a folder");
        let error = library(folder.path(), "m").expect_err("no binaries").to_string();
        assert_eq!(
            error,
            "has no library for this platform: binaries/linux64/m.so is missing, the archive has no binaries"
        );
        for platform in ["win64", "darwin64"] {
            std::fs::create_dir_all(folder.path().join("binaries").join(platform)).expect("a folder");
        }
        let error = library(folder.path(), "m").expect_err("no binary").to_string();
        assert!(error.ends_with("the archive has darwin64, win64"), "{error}");
        let path = folder.path().join("binaries/linux64/m.so");
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        std::fs::write(&path, "").expect("a library");
        assert_eq!(library(folder.path(), "m").expect("a library"), path);
    }
}
