//! The key and its timestamps on the disk. Both are for their owner alone.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use super::{Kept, SecretKey};
use crate::failure::Failure;
use crate::files::{Readers, replace};

/// Longer than any key.
const LONGEST: u64 = 256;

/// Where a key is kept.
#[derive(Clone, Debug)]
pub struct KeyFile {
    path: PathBuf,
    timestamps: PathBuf,
}

impl KeyFile {
    /// Reads a key, and the timestamps of a hub of links beside it if there are any: senders number their links as they
    /// like, so that each hub has streams of its own. An empty file has no key yet: SETUP_SIGNING brings it.
    ///
    /// # Errors
    /// [`Failure::File`], or [`Failure::Content`] if others may read it or it is not a key.
    pub fn open(path: &Path, hub: usize) -> Result<(Self, Option<SecretKey>, Kept), Failure> {
        let wrong = |path: &Path, reason: String| Failure::Content { path: path.to_owned(), reason };
        let (content, mode) = read(path).map_err(|source| Failure::read(path, source))?;
        if let Some(mode) = mode.filter(|mode| *mode != 0o600) {
            let reason = format!(
                "the mode is {mode:04o}; it must be 0600, so that nobody else can read the key: chmod 600 {}",
                path.display()
            );
            return Err(wrong(path, reason));
        }
        let key = SecretKey::read(&content);
        if key.is_none() && !content.trim_ascii().is_empty() {
            let reason = "not a signing key; the file must have 64 hexadecimal digits or 32 bytes, not all zero; with --accept-signing-setup it can be empty";
            return Err(wrong(path, reason.to_owned()));
        }
        let mut beside = path.to_owned().into_os_string();
        beside.push(if hub == 0 { ".timestamps".to_owned() } else { format!(".timestamps.{hub}") });
        let file = Self { path: path.to_owned(), timestamps: beside.into() };
        let kept = match std::fs::read_to_string(&file.timestamps) {
            Ok(text) => Kept::parse(&text).map_err(|line| {
                wrong(
                    &file.timestamps,
                    format!("line {line} is not a timestamp; restore the file: without it, recorded messages could be replayed"),
                )
            })?,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Kept::default(),
            Err(source) => return Err(Failure::read(&file.timestamps, source)),
        };
        Ok((file, key, kept))
    }

    /// Where the timestamps are.
    pub fn timestamps(&self) -> &Path {
        &self.timestamps
    }

    /// Keeps timestamps.
    ///
    /// # Errors
    /// The error of the file system; the old ones are still there.
    pub fn keep(&self, kept: &Kept) -> std::io::Result<()> {
        replace(&self.timestamps, kept.render().as_bytes(), Readers::Owner)
    }

    /// Keeps another key, or none.
    ///
    /// # Errors
    /// The error of the file system; the old one is still there.
    pub fn keep_key(&self, key: Option<&SecretKey>) -> std::io::Result<()> {
        let digits = key.map(SecretKey::to_digits).unwrap_or_default();
        replace(&self.path, digits.as_bytes(), Readers::Owner)
    }
}

/// Content, and mode where there are modes.
fn read(path: &Path) -> std::io::Result<(Vec<u8>, Option<u32>)> {
    let file = File::open(path)?;
    #[cfg(unix)]
    let mode = {
        use std::os::unix::fs::PermissionsExt;
        Some(file.metadata()?.permissions().mode() & 0o7777)
    };
    #[cfg(not(unix))]
    let mode = None;
    let mut content = Vec::new();
    file.take(LONGEST).read_to_end(&mut content)?;
    Ok((content, mode))
}

#[cfg(all(test, unix))]
mod tests {
    use std::os::unix::fs::PermissionsExt;

    use super::{Kept, KeyFile, SecretKey};

    #[test]
    fn key_and_timestamps_stay_private_and_are_found_again() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("key");
        let mode = |mode| std::fs::set_permissions(&path, PermissionsExt::from_mode(mode)).expect("a file");
        assert!(KeyFile::open(&path, 0).is_err(), "none");
        std::fs::write(&path, "").expect("written");
        for open in [0o644, 0o640, 0o700, 0o400, 0o4600] {
            mode(open);
            let text = KeyFile::open(&path, 0).expect_err("readable by others").to_string();
            assert!(text.contains("0600") && text.contains(&format!("{open:04o}")), "{text}");
        }
        mode(0o600);
        let (file, key, kept) = KeyFile::open(&path, 0).expect("empty");
        assert_eq!((key, kept), (None, Kept::default()));
        let key = SecretKey::new([7; 32]).expect("a key");
        let kept = Kept { sent: 3, forgotten: 2, streams: [((0, 1, 2), 9)].into() };
        file.keep_key(Some(&key)).expect("written");
        file.keep(&kept).expect("written");
        let (file, read, read_kept) = KeyFile::open(&path, 0).expect("kept");
        assert_eq!((read, read_kept), (Some(key), kept));
        let modes = std::fs::read_dir(folder.path()).expect("a folder").map(|entry| {
            entry.expect("an entry").metadata().expect("metadata").permissions().mode() & 0o7777
        });
        assert_eq!(modes.collect::<Vec<_>>(), [0o600; 2]);
        file.keep_key(None).expect("written");
        assert_eq!(KeyFile::open(&path, 0).expect("empty").1, None);
        std::fs::write(&path, "no key").expect("written");
        assert!(KeyFile::open(&path, 0).expect_err("no key").to_string().contains("64 hexadecimal"));
    }
}
