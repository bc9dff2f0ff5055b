//! Reading a record, line by line.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use super::checksum::Checksum;
use super::{Entry, Header};
use crate::failure::Failure;

/// Bytes of the longest line: the header has the settings and plans of all vehicles.
const LONGEST_LINE: u64 = 256 << 20;

/// The entries of a record, each checked. A last line without its end, as a killed program or a full disk leaves it, ends them.
#[derive(Debug)]
pub struct Reader {
    path: PathBuf,
    lines: BufReader<File>,
    checksum: Checksum,
    header: Header,
    /// Number of the line that was read last, and the simulation time of the last entry, µs.
    line: usize,
    time_us: u64,
    over: bool,
}

impl Reader {
    /// Opens a record and reads its header.
    ///
    /// # Errors
    /// [`Failure::File`], or [`Failure::Content`] if it is not a record of this version or its header is damaged.
    pub fn open(path: &Path) -> Result<Self, Failure> {
        let wrong = |reason: String| Failure::Content { path: path.to_owned(), reason };
        let file = File::open(path).map_err(|source| Failure::read(path, source))?;
        let mut lines = BufReader::new(file);
        let mut checksum = Checksum::default();
        let line = next_line(&mut lines).map_err(|source| Failure::read(path, source))?;
        Header::check_format(&line).map_err(wrong)?;
        let damaged = || wrong("line 1, the header, is damaged: its checksum is wrong".to_owned());
        let header = Header::parse(checksum.open(&line).ok_or_else(damaged)?).map_err(wrong)?;
        Ok(Self { path: path.to_owned(), lines, checksum, header, line: 1, time_us: 0, over: false })
    }

    /// The header.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// Number of the line that was read last.
    pub fn line(&self) -> usize {
        self.line
    }

    fn entry(&mut self) -> Result<Option<Entry>, Failure> {
        let line = next_line(&mut self.lines).map_err(|source| Failure::read(&self.path, source))?;
        if line.last() != Some(&b'\n') {
            return Ok(None);
        }
        self.line += 1;
        let Some(text) = self.checksum.open(&line) else { return Err(self.damaged()) };
        let entry = Entry::parse(text).filter(|entry| entry.vehicle < self.header.vehicles.len());
        let Some(entry) = entry else {
            let reason = format!("line {} is not an entry of this record", self.line);
            return Err(Failure::Content { path: self.path.clone(), reason });
        };
        self.time_us = entry.time_us;
        Ok(Some(entry))
    }

    fn damaged(&self) -> Failure {
        let reason = format!(
            "line {}, the entry after {:.6} s of simulation time, is damaged: its checksum is wrong. To replay what comes \
             before it, copy that to another file: head -n {} {}",
            self.line,
            self.time_us as f64 / 1e6,
            self.line - 1,
            self.path.display(),
        );
        Failure::Content { path: self.path.clone(), reason }
    }
}

impl Iterator for Reader {
    type Item = Result<Entry, Failure>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.over {
            return None;
        }
        let entry = self.entry().transpose();
        self.over = !matches!(entry, Some(Ok(_)));
        entry
    }
}

/// The next line with its end; without it if the file ends first.
fn next_line(lines: &mut impl BufRead) -> std::io::Result<Vec<u8>> {
    let mut line = Vec::new();
    lines.take(LONGEST_LINE).read_until(b'\n', &mut line)?;
    Ok(line)
}
