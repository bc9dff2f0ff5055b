//! What is written down of the traffic: the record to be replayed, and the log for ground stations.

use std::time::Instant;

use autopilot::codec::Frame;
use vehicle::foreign::ForeignMotion;
use vehicle::{Pulses, TICK_US};

use super::Member;
use crate::configuration::Settings;
use crate::failure::Failure;
use crate::files::{Notice, WRITE_PERIOD};
use crate::link::Received;
use crate::record::{Digest, Header, Participant, Recorder, TrafficLog};

/// How a flight has gone is recorded in such intervals of its simulation time, µs.
const STATE_PERIOD_US: u64 = 1_000_000;

/// Record and log, if they are asked for.
#[derive(Debug)]
pub struct Books {
    recorder: Option<Recorder>,
    traffic: Option<TrafficLog>,
    unix_start_us: u64,
    written: Instant,
    /// Whether a state has been recorded since then.
    is_state_new: bool,
}

impl Books {
    /// Begins the files.
    pub fn open(
        settings: &Settings,
        participants: Vec<Participant>,
        unix_start_us: u64,
    ) -> Result<Self, Failure> {
        let header = Header::new(settings.speed, participants).started_at(unix_start_us);
        let recorder = match &settings.record {
            Some(path) => Some(Recorder::create(path, &header, settings.record_most_bytes)?),
            None => None,
        };
        let traffic = match &settings.tlog {
            Some(path) => Some(TrafficLog::create(path, settings.logs.most_bytes, settings.logs.most_files)?),
            None => None,
        };
        Ok(Self { recorder, traffic, unix_start_us, written: Instant::now(), is_state_new: false })
    }

    /// A frame is on a link.
    pub fn traffic(&mut self, time_us: u64, frame: &Frame) {
        if let Some(traffic) = &mut self.traffic {
            traffic.frame(self.unix_start_us + time_us, frame);
        }
    }

    /// A member takes a frame in.
    pub fn received(&mut self, member: usize, time_us: u64, received: &Received) {
        if let Some(recorder) = &mut self.recorder {
            recorder.frame(member, time_us, &received.origin, &received.frame);
        }
    }

    /// A member's radio sends something else.
    pub fn radio(&mut self, member: usize, time_us: u64, pulses: &Pulses) {
        if let Some(recorder) = &mut self.recorder {
            recorder.radio(member, time_us, pulses);
        }
    }

    /// A member hears a ground station, or no more.
    pub fn ground_station(&mut self, member: usize, time_us: u64, heard: bool) {
        if let Some(recorder) = &mut self.recorder {
            recorder.ground_station(member, time_us, heard);
        }
    }

    /// What flies in place of ours has moved a member in the tick that began at a time, µs.
    pub fn motion(&mut self, member: usize, time_us: u64, motion: &ForeignMotion) {
        if let Some(recorder) = &mut self.recorder {
            recorder.motion(member, time_us, motion);
        }
    }

    /// How many ticks, up to `most`, a member flies at once from a time, µs, so that its state is recorded when it is due.
    pub fn ticks_to_state(&self, time_us: u64, most: u64) -> u64 {
        let to_state_us = STATE_PERIOD_US - time_us % STATE_PERIOD_US;
        if self.recorder.is_some() { most.min(to_state_us / TICK_US) } else { most }
    }

    /// A member has flown on: how its flight has gone is recorded each second of simulation time.
    pub fn flown(&mut self, number: usize, member: &Member) {
        let time_us = member.time_us();
        if !time_us.is_multiple_of(STATE_PERIOD_US) {
            return;
        }
        if let Some(recorder) = &mut self.recorder {
            recorder.state(number, time_us, member.digest());
            self.is_state_new = true;
        }
    }

    /// The simulation of a member has failed in the tick that follows.
    pub fn failure(&mut self, member: usize, time_us: u64, digest: Digest) {
        if let Some(recorder) = &mut self.recorder {
            recorder.failure(member, time_us, digest);
        }
    }

    /// Stops a record that has reached its size limit, before anything more is recorded.
    pub fn keep_size(&mut self, members: &[Member]) {
        if let Some(recorder) = self.recorder.as_mut().filter(|recorder| recorder.is_full()) {
            recorder.stop(flights(members));
        }
    }

    /// Writes what waits, each second of the wall clock, and the state of a flight at real time as soon as there is one: whoever ends the
    /// program all at once loses a second. Returns what to announce.
    pub fn keep_up(&mut self, now: Instant) -> Vec<Notice> {
        let mut notices = Vec::new();
        let period = if self.is_state_new { WRITE_PERIOD / 2 } else { WRITE_PERIOD };
        if now.saturating_duration_since(self.written) < period {
            return notices;
        }
        (self.written, self.is_state_new) = (now, false);
        notices.extend(self.recorder.as_mut().map(Recorder::flush).into_iter().flatten());
        notices.extend(self.traffic.as_mut().and_then(TrafficLog::flush));
        notices
    }

    /// Ends the files. Returns what is missing from them, a sentence each.
    pub fn finish(self, members: &[Member]) -> Vec<String> {
        let record = self.recorder.and_then(|mut recorder| {
            for (number, time_us, digest) in flights(members) {
                recorder.end(number, time_us, digest);
            }
            recorder.finish()
        });
        record.into_iter().chain(self.traffic.and_then(TrafficLog::finish)).collect()
    }
}

/// Number, time and digest of each that flies.
fn flights(members: &[Member]) -> impl Iterator<Item = (usize, u64, Digest)> {
    let flying = members.iter().enumerate().filter(|(_, member)| member.loss().is_none());
    flying.map(|(number, member)| (number, member.time_us(), member.digest()))
}
