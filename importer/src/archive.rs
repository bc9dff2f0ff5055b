//! Unpacking an archive that may come from anywhere.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

use tempfile::TempDir;
use zip::ZipArchive;

use crate::error::ImportError;

/// Most entries and most bytes of an archive. FMUs with whole interpreters and meshes in their resources are below a gigabyte.
const MOST_ENTRIES: usize = 100_000;
const MOST_BYTES: u64 = 4 << 30;

/// Unpacks a file into a temporary folder, which goes with the value.
///
/// # Errors
/// [`ImportError`] if it is no archive, has entries outside its folder, links, or more than the bounds.
pub(crate) fn unpack(path: &Path) -> Result<TempDir, ImportError> {
    let file = File::open(path)?;
    if file.metadata()?.is_dir() {
        return Err(ImportError::Archive("it is a folder".to_owned()));
    }
    let mut archive = ZipArchive::new(file).map_err(|error| ImportError::Archive(error.to_string()))?;
    if archive.len() > MOST_ENTRIES {
        return Err(ImportError::Refused(format!("it has more than {MOST_ENTRIES} entries")));
    }
    let folder = tempfile::Builder::new().prefix("fmu-").tempdir()?;
    let mut left = MOST_BYTES;
    for index in 0..archive.len() {
        let mut entry = archive.by_index(index).map_err(|error| ImportError::Archive(error.to_string()))?;
        let name = entry.name().map(|name| name.to_string());
        let name = name.map_err(|error| ImportError::Archive(error.to_string()))?;
        let refused = |reason: &str| ImportError::Refused(format!("the entry {name:?} {reason}"));
        let inside = entry.enclosed_name().ok_or_else(|| refused("leaves the archive's folder"))?;
        if inside.components().next().is_none() {
            continue;
        }
        if entry.is_symlink() {
            return Err(refused("is a symbolic link"));
        }
        let target = folder.path().join(inside);
        if entry.is_dir() {
            fs::create_dir_all(&target)?;
            continue;
        }
        if let Some(parent) = target.parent() {
            fs::create_dir_all(parent)?;
        }
        // What the header says of the size is only a claim.
        let mut file = File::create(&target)?;
        let written = io::copy(&mut (&mut entry).take(left.saturating_add(1)), &mut file);
        let written =
            written.map_err(|error| ImportError::Archive(format!("the entry {name:?}: {error}")))?;
        left = left.checked_sub(written).ok_or_else(|| refused("makes it larger than 4 GiB"))?;
    }
    Ok(folder)
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use zip::ZipWriter;
    use zip::write::SimpleFileOptions;

    use super::unpack;

    fn archive(entries: &[(&str, &str)]) -> tempfile::NamedTempFile {
        let file = tempfile::NamedTempFile::new().expect("a file");
        let mut writer = ZipWriter::new(file.reopen().expect("the file"));
        for (name, content) in entries {
            writer.start_file(*name, SimpleFileOptions::default()).expect("an entry");
            writer.write_all(content.as_bytes()).expect("its content");
        }
        writer.finish().expect("an archive");
        file
    }

    #[test]
    fn entries_are_unpacked_with_their_folders() {
        let file = archive(&[("modelDescription.xml", "<x/>"), ("binaries/linux64/m.so", "code")]);
        let folder = unpack(file.path()).expect("an archive");
        let text = std::fs::read_to_string(folder.path().join("binaries/linux64/m.so")).expect("an entry");
        assert_eq!(text, "code");
    }

    #[test]
    fn nothing_is_written_outside_the_folder() {
        for name in ["../outside.txt", "a/../../outside.txt", "/etc/outside.txt"] {
            let file = archive(&[(name, "x")]);
            match unpack(file.path()) {
                Err(error) => assert!(error.to_string().contains("leaves the archive's folder"), "{error}"),
                // An absolute name is taken as one below the folder.
                Ok(folder) => assert!(folder.path().join("etc/outside.txt").exists(), "{name}"),
            }
            assert!(!std::env::temp_dir().join("outside.txt").exists());
        }
    }

    #[test]
    fn what_is_no_archive_is_refused() {
        let file = tempfile::NamedTempFile::new().expect("a file");
        file.as_file().write_all(b"PK\x03\x04 no archive").expect("content");
        let error = unpack(file.path()).expect_err("no archive").to_string();
        assert!(error.starts_with("is not an FMU: "), "{error}");
        let error = unpack(&std::env::temp_dir()).expect_err("a folder").to_string();
        assert!(error.starts_with("is not an FMU: it is a folder"), "{error}");
    }
}
