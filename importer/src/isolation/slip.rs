//! The call that the host is making, where a crash cannot take it along: one byte of a file.

use std::fs::{File, OpenOptions};
use std::io;
use std::path::Path;

use crate::fmi2::Call;

/// The host's end.
#[derive(Debug)]
pub(super) struct Slip(File);

impl Slip {
    /// Makes the file.
    ///
    /// # Errors
    /// Those of the file.
    pub(super) fn create(path: &Path) -> io::Result<Self> {
        OpenOptions::new().write(true).create(true).truncate(true).open(path).map(Self)
    }

    /// Notes a call. A file that cannot be written costs the name of the call in a message, and nothing else.
    pub(super) fn note(&self, call: Call) {
        #[cfg(unix)]
        let _unknown = std::os::unix::fs::FileExt::write_at(&self.0, &[call.number()], 0);
        #[cfg(windows)]
        let _unknown = std::os::windows::fs::FileExt::seek_write(&self.0, &[call.number()], 0);
    }

    /// The call that was noted last.
    pub(super) fn read(path: &Path) -> Call {
        let bytes = std::fs::read(path).unwrap_or_default();
        bytes.first().map_or(Call::Nothing, |number| Call::numbered(*number))
    }
}
