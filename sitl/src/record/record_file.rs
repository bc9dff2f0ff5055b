//! The record file: lines of text.
//!
//! ```text
//! {"format":"lmpc-sitl record 2", …}        the vehicles and their settings
//! frame TIME_US VEHICLE LINK PEER HEX       a frame that a vehicle took in
//! station TIME_US VEHICLE 0|1               a ground station is heard no more, or (again)
//! end TIME_US VEHICLE DIGEST                the end of its flight, and the digest
//! ```
//!
//! Vehicles are numbered from zero in the order of the header; times are those of each one's own clock.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use autopilot::codec::Frame;
use autopilot::envelope::{LinkProfile, Origin, PeerId};
use serde::{Deserialize, Serialize};
use vehicle::VehicleSettings;
use vehicle::parameters::Speed;

use super::Digest;
use crate::failure::Failure;

/// Name and version of the format.
const FORMAT: &str = "lmpc-sitl record 2";

/// What a flight began with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    format: String,
    /// Version of the program.
    pub program: String,
    /// Pace at the start; it does not change the flights.
    pub speed: Speed,
    /// Time of the start since 1970, µs.
    #[serde(default)]
    pub unix_start_us: u64,
    /// The vehicles.
    pub vehicles: Vec<Participant>,
}

/// A vehicle of a record.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Participant {
    /// MAVLink system id.
    pub system_id: u8,
    /// What its links were for.
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
        /// Number of the vehicle.
        vehicle: usize,
        /// From whom.
        origin: Origin,
        /// The frame.
        frame: Frame,
    },
    /// A ground station is heard, or no more: that is judged by the wall clock.
    GroundStation {
        /// When, µs.
        time_us: u64,
        /// Number of the vehicle.
        vehicle: usize,
        /// Whether it is heard.
        heard: bool,
    },
    /// The end of a flight.
    End {
        /// When, µs.
        time_us: u64,
        /// Number of the vehicle.
        vehicle: usize,
        /// Its digest.
        digest: u64,
    },
}

impl Entry {
    /// Number of the vehicle.
    pub fn vehicle(&self) -> usize {
        let (Self::Frame { vehicle, .. } | Self::GroundStation { vehicle, .. } | Self::End { vehicle, .. }) =
            self;
        *vehicle
    }

    /// When, µs.
    pub fn time_us(&self) -> u64 {
        let (Self::Frame { time_us, .. } | Self::GroundStation { time_us, .. } | Self::End { time_us, .. }) =
            self;
        *time_us
    }
}

/// Writes a record.
#[derive(Debug)]
pub struct Recorder {
    path: PathBuf,
    file: BufWriter<File>,
}

impl Header {
    /// A header of this program.
    pub fn new(speed: Speed, vehicles: Vec<Participant>) -> Self {
        let program = env!("CARGO_PKG_VERSION").to_owned();
        Self { format: FORMAT.to_owned(), program, speed, unix_start_us: 0, vehicles }
    }

    /// The same with the time of the start since 1970, µs.
    pub fn started_at(self, unix_start_us: u64) -> Self {
        Self { unix_start_us, ..self }
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

    /// Records a frame that takes effect on a vehicle at a time.
    ///
    /// # Errors
    /// [`Failure::File`]
    pub fn frame(
        &mut self,
        vehicle: usize,
        time_us: u64,
        origin: &Origin,
        frame: &Frame,
    ) -> Result<(), Failure> {
        let PeerId { link, number } = origin.peer;
        let mut line = format!("frame {time_us} {vehicle} {link} {number} ");
        for byte in frame.bytes() {
            // Writing into a string cannot fail.
            let _infallible = write!(line, "{byte:02x}");
        }
        self.line(&line)
    }

    /// Records whether a vehicle hears a ground station from a time on.
    ///
    /// # Errors
    /// [`Failure::File`]
    pub fn ground_station(&mut self, vehicle: usize, time_us: u64, heard: bool) -> Result<(), Failure> {
        self.line(&format!("station {time_us} {vehicle} {}", u8::from(heard)))
    }

    /// Records the end of a vehicle's flight.
    ///
    /// # Errors
    /// [`Failure::File`]
    pub fn end(&mut self, vehicle: usize, time_us: u64, digest: Digest) -> Result<(), Failure> {
        self.line(&format!("end {time_us} {vehicle} {:016x}", digest.value()))
    }

    /// Ends the record.
    ///
    /// # Errors
    /// [`Failure::File`]
    pub fn finish(mut self) -> Result<(), Failure> {
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
        .map(|(number, line)| entry(line).ok_or_else(|| wrong(number, "is none of a record")))
        .collect::<Result<Vec<_>, _>>()?;
    Ok((header, entries))
}

fn entry(line: &str) -> Option<Entry> {
    let mut words = line.split(' ');
    let kind = words.next()?;
    let time_us = words.next()?.parse().ok()?;
    let vehicle = words.next()?.parse().ok()?;
    match kind {
        "frame" => {
            let peer = PeerId { link: words.next()?.parse().ok()?, number: words.next()?.parse().ok()? };
            let frame = Frame::parse(&bytes(words.next()?)?)?;
            let origin = Origin { peer, system: frame.system(), component: frame.component() };
            Some(Entry::Frame { time_us, vehicle, origin, frame })
        }
        "station" => {
            let heard = match words.next()? {
                "0" => false,
                "1" => true,
                _ => return None,
            };
            Some(Entry::GroundStation { time_us, vehicle, heard })
        }
        "end" => {
            let digest = u64::from_str_radix(words.next()?, 16).ok()?;
            Some(Entry::End { time_us, vehicle, digest })
        }
        _ => None,
    }
}

fn bytes(hex: &str) -> Option<Vec<u8>> {
    let digits = hex.as_bytes();
    let pair = |pair: &[u8]| u8::from_str_radix(std::str::from_utf8(pair).ok()?, 16).ok();
    if digits.len().is_multiple_of(2) { digits.chunks(2).map(pair).collect() } else { None }
}
