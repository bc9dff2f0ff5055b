//! What is written down of the traffic: the record to be replayed, and the log for ground stations.

use std::time::Instant;

use autopilot::codec::Frame;

use super::Member;
use crate::configuration::Settings;
use crate::failure::Failure;
use crate::link::Received;
use crate::record::{Header, Participant, Recorder, TrafficLog};

/// Record and log, if they are asked for.
#[derive(Debug)]
pub struct Books {
    recorder: Option<Recorder>,
    traffic: Option<TrafficLog>,
    unix_start_us: u64,
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
            Some(path) => Some(Recorder::create(path, &header)?),
            None => None,
        };
        let traffic = match &settings.tlog {
            Some(path) => Some(TrafficLog::create(path, settings.logs.most_bytes, settings.logs.most_files)?),
            None => None,
        };
        Ok(Self { recorder, traffic, unix_start_us })
    }

    /// A frame is on a link.
    pub fn traffic(&mut self, time_us: u64, frame: &Frame) -> Result<(), Failure> {
        match &mut self.traffic {
            Some(traffic) => traffic.frame(self.unix_start_us + time_us, frame),
            None => Ok(()),
        }
    }

    /// A member takes a frame in.
    pub fn received(&mut self, member: usize, time_us: u64, received: &Received) -> Result<(), Failure> {
        match &mut self.recorder {
            Some(recorder) => recorder.frame(member, time_us, &received.origin, &received.frame),
            None => Ok(()),
        }
    }

    /// A member hears a ground station, or no more.
    pub fn ground_station(&mut self, member: usize, time_us: u64, heard: bool) -> Result<(), Failure> {
        match &mut self.recorder {
            Some(recorder) => recorder.ground_station(member, time_us, heard),
            None => Ok(()),
        }
    }

    /// What was written reaches the disk, however slow simulation time is.
    pub fn keep_up(&mut self, now: Instant) -> Result<(), Failure> {
        self.traffic.as_mut().map_or(Ok(()), |traffic| traffic.keep_up(now))
    }

    /// Ends the files.
    pub fn finish(self, members: &[Member]) -> Result<(), Failure> {
        if let Some(mut recorder) = self.recorder {
            for (number, member) in members.iter().enumerate() {
                recorder.end(number, member.time_us(), member.digest())?;
            }
            recorder.finish()?;
        }
        self.traffic.map_or(Ok(()), TrafficLog::finish)
    }
}
