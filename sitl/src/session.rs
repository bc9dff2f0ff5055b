//! The running program: links, clock and files around the vehicle.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use crate::autopilot::Autopilot;
use crate::configuration::Settings;
use crate::failure::Failure;
use crate::link::Links;
use crate::pace::Pace;
use crate::parameters::Speed;
use crate::ready;
use crate::record::{Digest, Header, Recorder, TrafficLog};
use crate::terminal::StatusLine;

/// Longest rest between two looks at the links.
const REST: Duration = Duration::from_millis(1);
/// At full speed the links are looked at this often.
const BURST: Duration = Duration::from_millis(2);
/// A client must hear a heartbeat this often, however slow simulation time is.
const HEARTBEAT: Duration = Duration::from_millis(1_100);

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// Simulated time, µs.
    pub time_us: u64,
    /// Time of the wall clock.
    pub wall: Duration,
    /// Digest of the flight.
    pub digest: u64,
}

/// A vehicle with its surroundings.
#[derive(Debug)]
pub struct Session {
    settings: Settings,
    autopilot: Autopilot,
    links: Links,
    recorder: Option<Recorder>,
    traffic: Option<TrafficLog>,
    digest: Digest,
    unix_start_us: u64,
    last_heartbeat: Instant,
}

impl Session {
    /// Opens links and files.
    ///
    /// # Errors
    /// [`Failure`] of the first thing that cannot be used.
    pub fn new(settings: Settings) -> Result<Self, Failure> {
        let since_1970 = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        let unix_start_us = since_1970.as_micros() as u64;
        let (system_id, speed, profiles) = (settings.system_id, settings.speed, settings.profiles());
        let autopilot = Autopilot::new(&settings.vehicle, system_id, speed, &profiles, unix_start_us)?;
        let links = Links::open(&settings.links, system_id)?;
        let recorder = match &settings.record {
            Some(path) => {
                let header = Header::new(system_id, speed, profiles, settings.vehicle.clone());
                Some(Recorder::create(path, &header)?)
            }
            None => None,
        };
        let traffic = settings.tlog.as_deref().map(TrafficLog::create).transpose()?;
        Ok(Self {
            settings,
            autopilot,
            links,
            recorder,
            traffic,
            digest: Digest::default(),
            unix_start_us,
            last_heartbeat: Instant::now(),
        })
    }

    /// The links.
    pub fn links(&self) -> &Links {
        &self.links
    }

    /// Flies until it is told to stop, or the asked time is over.
    ///
    /// # Errors
    /// [`Failure`] of the simulation or of a file.
    pub fn run(mut self, stop: &Arc<AtomicBool>) -> Result<Summary, Failure> {
        let start = Instant::now();
        let mut pace = Pace::new(self.autopilot.speed(), start, 0);
        let mut status = StatusLine::new(start);
        if let Some(path) = &self.settings.ready_file {
            ready::write(path, &self.links)?;
        }
        while !stop.load(Ordering::Relaxed) && !self.is_over() {
            let now = Instant::now();
            self.receive(now)?;
            let time_us = self.autopilot.vehicle().time_us();
            let busy = match pace.goal_us(self.autopilot.speed(), now, time_us) {
                None => self.fly_for(BURST, now)?,
                Some(goal_us) => self.fly_to(goal_us)?,
            };
            self.keep_links_alive(now)?;
            self.links.flush();
            self.save_parameters()?;
            status.update(now, &self.autopilot, self.links.active_peers());
            if !busy {
                std::thread::sleep(REST);
            }
        }
        status.clear();
        let time_us = self.autopilot.vehicle().time_us();
        if let Some(recorder) = self.recorder {
            recorder.finish(time_us, self.digest)?;
        }
        if let Some(traffic) = self.traffic {
            traffic.finish()?;
        }
        Ok(Summary { time_us, wall: start.elapsed(), digest: self.digest.value() })
    }

    fn is_over(&self) -> bool {
        self.settings.end_us.is_some_and(|end_us| self.autopilot.vehicle().time_us() >= end_us)
    }

    fn receive(&mut self, now: Instant) -> Result<(), Failure> {
        for received in self.links.receive(now) {
            let time_us = self.autopilot.vehicle().time_us();
            if let Some(recorder) = &mut self.recorder {
                recorder.frame(time_us, &received.origin, &received.frame)?;
            }
            if let Some(traffic) = &mut self.traffic {
                traffic.frame(self.unix_start_us + time_us, &received.frame)?;
            }
            self.autopilot.receive(&received.origin, &received.frame);
            self.send(now)?;
        }
        Ok(())
    }

    fn tick(&mut self, now: Instant) -> Result<(), Failure> {
        self.autopilot.tick()?;
        self.digest.update(self.autopilot.vehicle());
        self.send(now)
    }

    /// Flies to a time. Whether it is still behind after that.
    fn fly_to(&mut self, goal_us: u64) -> Result<bool, Failure> {
        let start = Instant::now();
        while self.autopilot.vehicle().time_us() + crate::vehicle::TICK_US <= goal_us {
            self.tick(start)?;
            // The links must be looked at, too.
            if self.is_over() || start.elapsed() > 4 * BURST {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Flies for a while, as fast as possible.
    fn fly_for(&mut self, while_: Duration, now: Instant) -> Result<bool, Failure> {
        while now.elapsed() < while_ && !self.is_over() {
            // Asking the clock costs more than a tick.
            for _ in 0..16 {
                if self.is_over() {
                    break;
                }
                self.tick(now)?;
            }
        }
        Ok(true)
    }

    fn send(&mut self, now: Instant) -> Result<(), Failure> {
        const HEARTBEAT_ID: u32 = 0;
        for outgoing in self.autopilot.take_outgoing() {
            if outgoing.message.id() == HEARTBEAT_ID {
                self.last_heartbeat = now;
            }
            let frame = self.links.send(&outgoing);
            if let (Some(traffic), Some(frame)) = (&mut self.traffic, frame) {
                traffic.frame(self.unix_start_us + self.autopilot.vehicle().time_us(), &frame)?;
            }
        }
        Ok(())
    }

    fn keep_links_alive(&mut self, now: Instant) -> Result<(), Failure> {
        let slow = !matches!(self.autopilot.speed(), Speed::Max);
        if slow && now.saturating_duration_since(self.last_heartbeat) > HEARTBEAT {
            self.autopilot.keep_alive();
            self.send(now)?;
        }
        Ok(())
    }

    fn save_parameters(&mut self) -> Result<(), Failure> {
        let Some(path) = &self.settings.parameters else { return Ok(()) };
        let Some(text) = self.autopilot.take_changed_parameters() else { return Ok(()) };
        // A crash in between leaves the old file.
        let beside = path.with_extension("new");
        std::fs::write(&beside, text)
            .and_then(|()| std::fs::rename(&beside, path))
            .map_err(|source| Failure::write(path, source))
    }
}
