//! Writing a record.

use std::fs::File;
use std::path::Path;

use autopilot::codec::Frame;
use autopilot::envelope::Origin;

use super::checksum::Checksum;
use super::{Digest, Entry, Event, Header};
use crate::failure::Failure;
use crate::files::{FileLock, Notice, Spool, Upkeep};
use vehicle::Pulses;
use vehicle::Severity;
use vehicle::foreign::ForeignMotion;

/// What stops a record before the flights end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stop {
    /// It has reached its size limit.
    Limit,
    /// The disk has been full for longer than memory could bridge.
    Gap,
}

/// Writes a record: lines wait in memory until [`Self::flush`], or until there are many.
#[derive(Debug)]
pub struct Recorder {
    spool: Spool<File>,
    checksum: Checksum,
    upkeep: Upkeep,
    most_bytes: u64,
    /// Since when nothing more is recorded, µs, and why.
    stopped: Option<(u64, Stop)>,
    told: bool,
    _lock: Option<FileLock>,
}

impl Recorder {
    /// Begins a record of at most about so many bytes. Its header is on the disk when this returns.
    ///
    /// # Errors
    /// [`Failure::File`], or [`Failure::Content`] when another process writes the file.
    pub fn create(path: &Path, header: &Header, most_bytes: u64) -> Result<Self, Failure> {
        let failed = |source| Failure::write(path, source);
        let lock = FileLock::claim(path)?;
        let file = File::create(path).map_err(failed)?;
        let mut recorder = Self {
            spool: Spool::new(file),
            checksum: Checksum::default(),
            upkeep: Upkeep::new("Record", path),
            most_bytes,
            stopped: None,
            told: false,
            _lock: lock,
        };
        let text = serde_json::to_string(header).map_err(|error| failed(error.into()))?;
        recorder.line(0, &text);
        recorder.spool.flush().map_err(failed)?;
        Ok(recorder)
    }

    /// Records a frame that takes effect on a vehicle at a time, µs.
    pub fn frame(&mut self, vehicle: usize, time_us: u64, origin: &Origin, frame: &Frame) {
        self.entry(vehicle, time_us, Event::Frame(*origin, frame.clone()));
    }

    /// Records whether a vehicle hears a ground station from a time on, µs.
    pub fn ground_station(&mut self, vehicle: usize, time_us: u64, heard: bool) {
        self.entry(vehicle, time_us, Event::GroundStation(heard));
    }

    /// Records what a pilot's radio sends to a vehicle from a time on, µs.
    pub fn radio(&mut self, vehicle: usize, time_us: u64, pulses: &Pulses) {
        self.entry(vehicle, time_us, Event::Radio(*pulses));
    }

    /// Records how a foreign model has moved a vehicle in the tick that began at a time, µs.
    pub fn motion(&mut self, vehicle: usize, time_us: u64, motion: &ForeignMotion) {
        self.entry(vehicle, time_us, Event::Motion(motion.values()));
    }

    /// Records how a flight has gone up to a time, µs, by its digest. A record that is cut is compared up to there.
    pub fn state(&mut self, vehicle: usize, time_us: u64, digest: Digest) {
        self.entry(vehicle, time_us, Event::State(digest.value()));
    }

    /// Records the end of a vehicle's flight.
    pub fn end(&mut self, vehicle: usize, time_us: u64, digest: Digest) {
        self.entry(vehicle, time_us, Event::End(digest.value()));
    }

    /// Records that the simulation of a vehicle failed in the tick after a time, µs.
    pub fn failure(&mut self, vehicle: usize, time_us: u64, digest: Digest) {
        self.entry(vehicle, time_us, Event::Failure(digest.value()));
    }

    /// Whether it has reached its size limit and [`Self::stop`] is due.
    pub fn is_full(&self) -> bool {
        self.stopped.is_none() && self.spool.bytes() >= self.most_bytes
    }

    /// Stops a record that is full: of each vehicle its number, time and digest. The flights go on.
    pub fn stop(&mut self, flights: impl Iterator<Item = (usize, u64, Digest)>) {
        let mut stopped_us = 0;
        for (vehicle, time_us, digest) in flights {
            self.entry(vehicle, time_us, Event::Limit(digest.value()));
            stopped_us = stopped_us.max(time_us);
        }
        self.stopped.get_or_insert((stopped_us, Stop::Limit));
    }

    /// Writes what waits. Returns what to announce.
    pub fn flush(&mut self) -> Vec<Notice> {
        let mut notices: Vec<Notice> = self.upkeep.judge(self.spool.flush()).into_iter().collect();
        if let Some((time_us, stop)) = self.stopped.filter(|_| !std::mem::replace(&mut self.told, true)) {
            let (severity, reason) = match stop {
                Stop::Limit => (Severity::Warning, "size limit"),
                Stop::Gap => (Severity::Error, "disk full for too long"),
            };
            notices.push((severity, format!("Record ends at {:.1} s: {reason}", time_us as f64 / 1e6)));
        }
        notices
    }

    /// Ends the record. Returns what is missing from it, if anything is.
    pub fn finish(mut self) -> Option<String> {
        let _told_below = self.upkeep.judge(self.spool.flush());
        match self.stopped {
            Some((time_us, Stop::Gap)) => {
                Some(self.upkeep.lacks(&format!("ends at {:.3} s", time_us as f64 / 1e6)))
            }
            Some((time_us, Stop::Limit)) if !self.upkeep.is_failing() => {
                let reason = format!("ends at {:.3} s, by --record-size", time_us as f64 / 1e6);
                tracing::warn!("{}", self.upkeep.lacks(&reason));
                None
            }
            _ => self.upkeep.is_failing().then(|| self.upkeep.lacks("ends early")),
        }
    }

    fn entry(&mut self, vehicle: usize, time_us: u64, event: Event) {
        if self.stopped.is_none() {
            self.line(time_us, &Entry { time_us, vehicle, event }.to_string());
        }
    }

    fn line(&mut self, time_us: u64, text: &str) {
        let line = self.checksum.seal(text);
        if !self.spool.append(line.as_bytes()) {
            // A record with a gap could not be replayed beyond it.
            self.stopped = Some((time_us, Stop::Gap));
        }
    }
}
