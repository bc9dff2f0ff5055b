//! `.tlog`: each frame behind its time, as ground stations write them.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::codec::Frame;
use crate::failure::Failure;

/// How often it reaches the disk, µs of its own time.
const FLUSH_US: u64 = 1_000_000;

/// A log of all traffic.
#[derive(Debug)]
pub struct TrafficLog {
    path: PathBuf,
    file: BufWriter<File>,
    flushed_us: u64,
}

impl TrafficLog {
    /// Begins a log.
    ///
    /// # Errors
    /// [`Failure::File`]
    pub fn create(path: &Path) -> Result<Self, Failure> {
        let file = File::create(path).map_err(|source| Failure::write(path, source))?;
        Ok(Self { path: path.to_owned(), file: BufWriter::new(file), flushed_us: 0 })
    }

    /// Logs a frame: microseconds since 1970, most significant byte first, then the frame.
    ///
    /// # Errors
    /// [`Failure::File`]
    pub fn frame(&mut self, unix_us: u64, frame: &Frame) -> Result<(), Failure> {
        let written = self
            .file
            .write_all(&unix_us.to_be_bytes())
            .and_then(|()| self.file.write_all(frame.bytes()))
            .and_then(|()| if unix_us >= self.flushed_us + FLUSH_US { self.file.flush() } else { Ok(()) });
        self.flushed_us = if unix_us >= self.flushed_us + FLUSH_US { unix_us } else { self.flushed_us };
        written.map_err(|source| Failure::write(&self.path, source))
    }

    /// Ends the log.
    ///
    /// # Errors
    /// [`Failure::File`]
    pub fn finish(mut self) -> Result<(), Failure> {
        self.file.flush().map_err(|source| Failure::write(&self.path, source))
    }
}
