//! The record file: lines of text.
//!
//! ```text
//! {"format":"lmpc-sitl record 1", …}        the vehicle and its settings
//! frame TIME_US LINK PEER HEX               a received frame
//! end TIME_US DIGEST                        the end, and the digest of the flight
//! ```

use std::fmt::Write as _;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::Digest;
use crate::codec::Frame;
use crate::failure::Failure;
use crate::parameters::Speed;
use crate::service::{LinkProfile, Origin, PeerId};
use crate::vehicle::VehicleSettings;

/// Name and version of the format.
const FORMAT: &str = "lmpc-sitl record 1";

/// What a flight began with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    format: String,
    /// Version of the program.
    pub program: String,
    /// MAVLink system id.
    pub system_id: u8,
    /// Pace at the start; it does not change the flight.
    pub speed: Speed,
    /// What the links were for.
    pub links: Vec<LinkProfile>,
    /// The vehicle.
    pub vehicle: VehicleSettings,
}

/// One line behind the header.
#[derive(Clone, Debug, PartialEq)]
pub enum Entry {
    /// A received frame.
    Frame {
        /// When, µs.
        time_us: u64,
        /// From whom.
        origin: Origin,
        /// The frame.
        frame: Frame,
    },
    /// The end of the flight.
    End {
        /// When, µs.
        time_us: u64,
        /// Its digest.
        digest: u64,
    },
}

/// Writes a record.
#[derive(Debug)]
pub struct Recorder {
    path: PathBuf,
    file: BufWriter<File>,
}

impl Header {
    /// A header of this program.
    pub fn new(system_id: u8, speed: Speed, links: Vec<LinkProfile>, vehicle: VehicleSettings) -> Self {
        let program = env!("CARGO_PKG_VERSION").to_owned();
        Self { format: FORMAT.to_owned(), program, system_id, speed, links, vehicle }
    }
}

impl Recorder {
    /// Begins a record.
    ///
    /// # Errors
    /// [`Failure::File`]
    pub fn create(path: &Path, header: &Header) -> Result<Self, Failure> {
        let file = File::create(path).map_err(|source| Failure::write(path, source))?;
        let mut recorder = Self { path: path.to_owned(), file: BufWriter::new(file) };
        let line = serde_json::to_string(header).map_err(|error| Failure::write(path, error.into()))?;
        recorder.line(&line)?;
        Ok(recorder)
    }

    /// Records a frame that takes effect at a time.
    ///
    /// # Errors
    /// [`Failure::File`]
    pub fn frame(&mut self, time_us: u64, origin: &Origin, frame: &Frame) -> Result<(), Failure> {
        let mut line = format!("frame {time_us} {} {} ", origin.peer.link, origin.peer.number);
        for byte in frame.bytes() {
            // Writing into a string cannot fail.
            let _infallible = write!(line, "{byte:02x}");
        }
        self.line(&line)
    }

    /// Ends the record.
    ///
    /// # Errors
    /// [`Failure::File`]
    pub fn finish(mut self, time_us: u64, digest: Digest) -> Result<(), Failure> {
        self.line(&format!("end {time_us} {:016x}", digest.value()))?;
        self.file.flush().map_err(|source| Failure::write(&self.path, source))
    }

    fn line(&mut self, line: &str) -> Result<(), Failure> {
        writeln!(self.file, "{line}").map_err(|source| Failure::write(&self.path, source))
    }
}

/// Reads a record.
///
/// # Errors
/// [`Failure::File`], or [`Failure::Content`] with the first wrong line.
pub fn read(path: &Path) -> Result<(Header, Vec<Entry>), Failure> {
    let text = std::fs::read_to_string(path).map_err(|source| Failure::read(path, source))?;
    let wrong = |line: usize, reason: &str| Failure::Content {
        path: path.to_owned(),
        reason: format!("line {line} {reason}"),
    };
    let mut lines = (1..).zip(text.lines());
    let header = lines.next().map(|(_, line)| serde_json::from_str::<Header>(line));
    let Some(Ok(header)) = header.filter(|header| !matches!(header, Ok(header) if header.format != FORMAT))
    else {
        return Err(wrong(1, &format!("is not the header of a record (`{FORMAT}`)")));
    };
    let entries = lines
        .map(|(number, line)| entry(line).ok_or_else(|| wrong(number, "is neither a frame nor the end")))
        .collect::<Result<Vec<_>, _>>()?;
    match entries.last() {
        Some(Entry::End { .. }) => Ok((header, entries)),
        _ => Err(Failure::Content { path: path.to_owned(), reason: "the record has no end".to_owned() }),
    }
}

fn entry(line: &str) -> Option<Entry> {
    let mut words = line.split(' ');
    let kind = words.next()?;
    let time_us = words.next()?.parse().ok()?;
    match kind {
        "frame" => {
            let peer = PeerId { link: words.next()?.parse().ok()?, number: words.next()?.parse().ok()? };
            let frame = Frame::parse(&bytes(words.next()?)?)?;
            let origin = Origin { peer, system: frame.system(), component: frame.component() };
            Some(Entry::Frame { time_us, origin, frame })
        }
        "end" => Some(Entry::End { time_us, digest: u64::from_str_radix(words.next()?, 16).ok()? }),
        _ => None,
    }
}

fn bytes(hex: &str) -> Option<Vec<u8>> {
    let digits = hex.as_bytes();
    let pair = |pair: &[u8]| u8::from_str_radix(std::str::from_utf8(pair).ok()?, 16).ok();
    if digits.len().is_multiple_of(2) { digits.chunks(2).map(pair).collect() } else { None }
}
