//! The log of the present flight: begins, samples, ends.

use std::fs::File;
use std::time::Instant;

use autopilot::Autopilot;
use autopilot::service::version;
use vehicle::parameters::Value;

use super::log_file::LogFile;
use super::row::Row;
use super::settings::{LogSettings, LogStart};
use super::topics::{GRID_US, LogSource, TOPICS};
use super::ulog::{self, Definitions};
use crate::files::{LogFolder, Notice, Upkeep, WRITE_PERIOD};

/// How often data reach the disk in simulation time, µs; by the wall clock it is at least each [`WRITE_PERIOD`].
const FLUSH_US: u64 = 1_000_000;
/// What pilots call it.
const NAME: &str = "Flight log";
/// A flight's log goes on for this long after it, µs.
const AFTERMATH_US: u64 = 1_000_000;

/// A log that is being written.
#[derive(Debug)]
struct Current {
    name: String,
    file: LogFile<File>,
    /// Parameters as the log has them.
    parameters: Vec<Value>,
    /// What was logged last of each topic that is watched.
    last: Vec<Row>,
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
        }
    }

    /// Takes a tick of the vehicle in.
    pub fn tick(&mut self, autopilot: &mut Autopilot, now: Instant) {
        let (time_us, armed) = (autopilot.vehicle().time_us(), autopilot.vehicle().is_armed());
        let wanted = armed || self.settings.start == LogStart::Boot;
        let again = self.retry_us.is_some_and(|retry_us| time_us >= retry_us);
        if wanted && (!self.wanted || again) {
            self.finish(autopilot);
            self.begin(autopilot, now);
        }
        if self.wanted && !wanted {
            self.until_us = Some(time_us + AFTERMATH_US);
            self.retry_us = None;
        }
        self.until_us = self.until_us.filter(|_| !wanted);
        // Arming and disarming are on it, whatever comes next.
        let edge = std::mem::replace(&mut self.wanted, wanted) != wanted;
        if self.current.is_none() {
            return;
        }
        self.write_texts(autopilot);
        if !edge && !time_us.is_multiple_of(GRID_US) {
            return;
        }
        self.sample(autopilot);
        let over = self.until_us.is_some_and(|until_us| time_us >= until_us);
        let due = self.current.as_ref().is_some_and(|current| time_us >= current.flushed_us + FLUSH_US);
        if over {
            self.finish(autopilot);
        } else if due {
            self.flush(autopilot, now);
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
        announce(autopilot, current.upkeep.judge(current.file.flush(time_us)));
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
        match self.folder.create(autopilot.system_id(), self.settings.most_files) {
            Ok((name, file)) => {
                tracing::info!("logging to {}", self.folder.path().join(&name).display());
                let parameters = parameters(autopilot);
                let file = LogFile::new(file, &definitions(autopilot, &parameters));
                let (last, time_us) = (vec![Row::default(); TOPICS.len()], autopilot.vehicle().time_us());
                let upkeep = Upkeep::new(NAME, &self.folder.path().join(&name));
                self.current =
                    Some(Current { name, file, parameters, last, flushed_us: time_us, flushed: now, upkeep });
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
            ulog::text(&mut self.messages, severity.level(), when_us, &text);
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
        let mut row = Row::default();
        for ((number, topic), last) in (0..).zip(TOPICS).zip(&mut current.last) {
            let due = time_us.is_multiple_of(topic.period_us);
            // The first sample of all topics stands at the beginning.
            if !due && !topic.on_change && !last.0.is_empty() {
                continue;
            }
            row.0.clear();
            row.u64(time_us);
            (topic.sample)(&source, &mut row);
            const TIMESTAMP: usize = 8;
            if due || last.0.get(TIMESTAMP..) != row.0.get(TIMESTAMP..) {
                ulog::data(&mut self.messages, number, &row.0);
                last.0.clone_from(&row.0);
            }
        }
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
                ulog::parameter(&mut self.messages, entry.id, *value);
            }
        }
        current.parameters = present;
        current.file.append(time_us, &self.messages);
        (current.flushed_us, current.flushed) = (time_us, now);
        let full = current.file.bytes() >= self.settings.most_bytes;
        announce(autopilot, current.upkeep.judge(current.file.flush(time_us)));
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

/// PX4's number of the meaning of topics: from 2 on, readers look for places of the GPS receiver in degrees.
const DATA_FORMAT: u32 = 2;

fn definitions(autopilot: &Autopilot, parameters: &[Value]) -> Vec<u8> {
    let mut definitions = Definitions::new(autopilot.vehicle().time_us());
    definitions.information("sys_name", "lmpc-sitl");
    definitions.information("ver_hw", "LMPC_SITL");
    definitions.information("ver_sw", concat!("lmpc-sitl ", env!("CARGO_PKG_VERSION")));
    definitions.number("ver_data_format", DATA_FORMAT);
    definitions.number("ver_sw_release", version());
    definitions.information("sys_uuid", &format!("lmpc-sitl-{:03}", autopilot.system_id()));
    for topic in TOPICS {
        definitions.topic(topic.name, &format!("uint64_t timestamp;{}", topic.fields));
    }
    for (entry, value) in autopilot.parameter_table().entries().iter().zip(parameters) {
        definitions.parameter(entry.id, *value);
    }
    definitions.finish()
}
