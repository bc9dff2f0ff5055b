//! The log of the present flight: begins, samples, ends.

use std::fs::File;
use std::time::Instant;

use autopilot::Autopilot;
use vehicle::parameters::Value;

use super::LogSource;
use super::format::{LogFormat, LogWriter};
use super::log_file::LogFile;
use super::settings::{GRID_US, LogSettings, LogStart};
use crate::files::{LogFolder, Notice, Upkeep, WRITE_PERIOD};

/// How often data reach the disk in simulation time, µs; by the wall clock it is at least each [`WRITE_PERIOD`].
const FLUSH_US: u64 = 1_000_000;
/// What pilots call it.
const NAME: &str = "Flight log";
/// A flight's log goes on for this long after it, µs; ArduPilot's for longer.
const AFTERMATH_US: u64 = 1_000_000;
const ARDUPILOT_AFTERMATH_US: u64 = 15_000_000;

/// A log that is being written.
#[derive(Debug)]
struct Current {
    name: String,
    file: LogFile<File>,
    /// Parameters as the log has them.
    parameters: Vec<Value>,
    writer: Box<dyn LogWriter>,
    /// Whether nothing is written between two flights.
    rests: bool,
    flushed_us: u64,
    flushed: Instant,
    upkeep: Upkeep,
}

/// Writes logs.
#[derive(Debug)]
pub struct FlightLog {
    folder: LogFolder,
    settings: LogSettings,
    current: Option<Current>,
    wanted: bool,
    /// Until when the log of a flight that is over goes on, µs.
    until_us: Option<u64>,
    messages: Vec<u8>,
    /// Whether the disk takes new logs.
    folder_upkeep: Upkeep,
    /// When a log that could not begin is tried again, µs.
    retry_us: Option<u64>,
    /// What is missing from the logs, a sentence each.
    lacking: Vec<String>,
    /// Boots of the vehicle that it has seen.
    boots: u32,
}

impl FlightLog {
    /// Logs into a folder.
    pub fn new(folder: LogFolder, settings: LogSettings) -> Self {
        Self {
            folder_upkeep: Upkeep::new(NAME, folder.path()),
            folder,
            settings,
            current: None,
            wanted: false,
            until_us: None,
            messages: Vec::new(),
            retry_us: None,
            lacking: Vec::new(),
            boots: 1,
        }
    }

    /// Takes a tick of the vehicle in.
    pub fn tick(&mut self, autopilot: &mut Autopilot, now: Instant) {
        if std::mem::replace(&mut self.boots, autopilot.boots()) != autopilot.boots() {
            // The vehicle that the log was of is no more.
            self.finish(autopilot);
            self.wanted = false;
        }
        let time_us = autopilot.vehicle().time_us();
        let habits = Habits::of(autopilot);
        let armed = autopilot.vehicle().is_armed();
        let wanted = armed || habits.always || self.settings.start == LogStart::Boot;
        let again = self.retry_us.is_some_and(|retry_us| time_us >= retry_us);
        if wanted && (!self.wanted || again) {
            self.begin_or_go_on(autopilot, now);
        }
        if self.wanted && !wanted {
            self.until_us = Some(time_us + habits.aftermath_us);
            self.retry_us = None;
        }
        self.until_us = self.until_us.filter(|_| !wanted);
        // Arming and disarming are on it, whatever comes next.
        let edge = std::mem::replace(&mut self.wanted, wanted) != wanted;
        let Some(current) = self.current.as_ref().filter(|current| !current.rests) else { return };
        let sampled = time_us.is_multiple_of(GRID_US) || current.writer.is_due_between(autopilot.vehicle());
        self.write_texts(autopilot);
        if !edge && !sampled {
            return;
        }
        self.sample(autopilot);
        let over = self.until_us.is_some_and(|until_us| time_us >= until_us);
        let due = self.current.as_ref().is_some_and(|current| time_us >= current.flushed_us + FLUSH_US);
        if over && habits.rests {
            self.flush(autopilot, now);
            self.until_us = None;
            self.current.iter_mut().for_each(|current| current.rests = true);
        } else if over {
            self.finish(autopilot);
        } else if due {
            self.flush(autopilot, now);
        }
    }

    /// Begins a log, or goes on with one that rests.
    fn begin_or_go_on(&mut self, autopilot: &mut Autopilot, now: Instant) {
        let rests = Habits::of(autopilot).rests;
        match self.current.as_mut().filter(|_| rests && self.retry_us.is_none()) {
            Some(current) => current.rests = false,
            None => {
                self.finish(autopilot);
                self.begin(autopilot, now);
            }
        }
    }

    /// Flushes if the wall clock says so: simulation time may be slow.
    pub fn keep_up(&mut self, autopilot: &mut Autopilot, now: Instant) {
        let since = |current: &Current| now.saturating_duration_since(current.flushed);
        if self.current.as_ref().is_some_and(|current| since(current) >= WRITE_PERIOD) {
            self.flush(autopilot, now);
        }
    }

    /// Ends the log, if there is one.
    pub fn finish(&mut self, autopilot: &mut Autopilot) {
        (self.until_us, self.retry_us) = (None, None);
        let Some(mut current) = self.current.take() else { return };
        let time_us = autopilot.vehicle().time_us();
        announce(autopilot, current.upkeep.judge(current.file.flush(time_us, &*current.writer)));
        let dropped_s = current.file.dropped_us(time_us) as f64 / 1e6;
        if dropped_s > 0.0 {
            self.lacking.push(current.upkeep.lacks(&format!("lacks {dropped_s:.1} s of data")));
        } else if current.upkeep.is_failing() {
            self.lacking.push(current.upkeep.lacks("ends early"));
        }
        self.folder.finish(&current.name);
    }

    /// What is missing from the logs that are over, a sentence each.
    pub fn take_lacking(&mut self) -> Vec<String> {
        std::mem::take(&mut self.lacking)
    }

    fn begin(&mut self, autopilot: &mut Autopilot, now: Instant) {
        let format = LogFormat::of(autopilot.identity());
        let created = match format {
            LogFormat::ULog => self.folder.create(autopilot.system_id(), self.settings.most_files),
            LogFormat::DataFlash => self.folder.create_numbered(self.settings.most_files),
        };
        match created {
            Ok((name, file)) => {
                tracing::info!("logging to {}", self.folder.path().join(&name).display());
                let parameters = parameters(autopilot);
                let mut writer = format.writer();
                let file = LogFile::new(file, &writer.begin(autopilot, &parameters));
                let time_us = autopilot.vehicle().time_us();
                let upkeep = Upkeep::new(NAME, &self.folder.path().join(&name));
                self.current = Some(Current {
                    name,
                    file,
                    parameters,
                    writer,
                    rests: false,
                    flushed_us: time_us,
                    flushed: now,
                    upkeep,
                });
                announce(autopilot, self.folder_upkeep.judge(Ok(())));
                self.flush(autopilot, now);
            }
            Err(error) => {
                if !self.folder_upkeep.is_failing() {
                    let time_s = autopilot.vehicle().time_us() as f64 / 1e6;
                    let lacks = format!("lacks data from {time_s:.1} s on");
                    announce(autopilot, self.folder_upkeep.judge(Err(error)));
                    self.lacking.push(self.folder_upkeep.lacks(&lacks));
                }
                self.retry_us = Some(autopilot.vehicle().time_us() + FLUSH_US);
            }
        }
    }

    fn write_texts(&mut self, autopilot: &mut Autopilot) {
        let Some(current) = &mut self.current else { return };
        let time_us = autopilot.vehicle().time_us();
        self.messages.clear();
        // What was said while there was no log belongs to none, but for what it began with.
        let texts = autopilot.take_texts().into_iter();
        for (when_us, severity, text) in texts.filter(|(when_us, ..)| when_us + FLUSH_US >= time_us) {
            current.writer.text(&mut self.messages, when_us, severity, &text);
        }
        if !self.messages.is_empty() {
            current.file.append(time_us, &self.messages);
        }
    }

    fn sample(&mut self, autopilot: &Autopilot) {
        let Some(current) = &mut self.current else { return };
        let source = LogSource::of(autopilot);
        let time_us = source.vehicle.time_us();
        self.messages.clear();
        current.writer.sample(&mut self.messages, &source);
        current.file.append(time_us, &self.messages);
    }

    fn flush(&mut self, autopilot: &mut Autopilot, now: Instant) {
        let Some(current) = &mut self.current else { return };
        let time_us = autopilot.vehicle().time_us();
        self.messages.clear();
        let present = parameters(autopilot);
        let entries = autopilot.parameter_table().entries();
        for ((entry, value), logged) in entries.iter().zip(&present).zip(&current.parameters) {
            if value != logged {
                current.writer.parameter(&mut self.messages, time_us, entry.id, *value);
            }
        }
        current.parameters = present;
        current.file.append(time_us, &self.messages);
        (current.flushed_us, current.flushed) = (time_us, now);
        let full = current.file.bytes() >= self.settings.most_bytes;
        announce(autopilot, current.upkeep.judge(current.file.flush(time_us, &*current.writer)));
        // A disk that takes no more data takes no new file, either.
        if full && !current.upkeep.is_failing() {
            let until_us = self.until_us;
            self.finish(autopilot);
            self.begin(autopilot, now);
            self.until_us = until_us;
        }
    }
}

fn announce(autopilot: &mut Autopilot, notice: Option<Notice>) {
    if let Some((severity, text)) = notice {
        autopilot.announce(severity, &text);
    }
}

fn parameters(autopilot: &Autopilot) -> Vec<Value> {
    autopilot.parameters().map(|(_, value)| value).collect()
}

/// When logs begin and end.
#[derive(Clone, Copy, Debug)]
struct Habits {
    /// Whether it is written while disarmed, too.
    always: bool,
    /// Whether one log serves all flights of a boot.
    rests: bool,
    /// How long it goes on after a flight, µs.
    aftermath_us: u64,
}

impl Habits {
    fn of(autopilot: &Autopilot) -> Self {
        let log = &autopilot.vehicle().conduct().log;
        match LogFormat::of(autopilot.identity()) {
            LogFormat::ULog => Self { always: false, rests: false, aftermath_us: AFTERMATH_US },
            LogFormat::DataFlash => Self {
                always: log.disarmed != 0,
                rests: !log.rotates,
                aftermath_us: if log.rotates { AFTERMATH_US } else { ARDUPILOT_AFTERMATH_US },
            },
        }
    }
}
