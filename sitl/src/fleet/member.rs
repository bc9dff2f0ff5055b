//! One vehicle among those of a run.

use std::net::SocketAddr;
use std::time::{Duration, Instant};

use autopilot::Autopilot;
use autopilot::codec::Frame;
use autopilot::envelope::PeerId;
use autopilot::file_work::FileWorker;
use vehicle::foreign::ForeignModel;
use vehicle::parameters::{FileFormat, Speed};
use vehicle::{FlightError, Mode, TICK_US, Vehicle};

use super::kept_file::KeptFile;
use super::lockstep::{Circumstances, Lockstep, LockstepSettings};
use super::loss::Loss;
use crate::failure::Failure;
use crate::files::render_plans;
use crate::flight_log::{FlightLog, StreamedLog};
use crate::radio_port::RadioPort;
use crate::record::{Digest, Participant};
use crate::terminal::set_simulation_time;

/// A client must hear a heartbeat this often, however slow simulation time is.
const HEARTBEAT: Duration = Duration::from_millis(1_100);

/// Turns of long answers per second of the wall clock: as many messages of a list as clients can read.
const TURNS_PER_S: f64 = 2_500.0;
/// Of one look at the links.
const MOST_TURNS: u64 = 50;
/// Whoever has no long answer to give is asked this often all the same: it hears who is gone.
const SELDOM: Duration = Duration::from_millis(50);

/// A vehicle, what is known of its flight, and where it is reached.
#[derive(Debug)]
pub struct Member {
    /// Large, and in its place from the start: members are moved.
    pub(super) autopilot: Box<Autopilot>,
    pub(super) hub: usize,
    pub(super) last_heartbeat: Instant,
    pub(super) lockstep: Option<Lockstep>,
    pub(super) radio: Option<RadioPort>,
    /// When a ground station was heard last, and what the vehicle knows of it.
    ground_station: Option<(Instant, bool)>,
    digest: Digest,
    parameters: Option<KeptFile>,
    plans: Option<KeptFile>,
    /// Boot and revision of the plans that are kept.
    kept_revision: (u32, u32),
    log: Option<FlightLog>,
    streamed: StreamedLog,
    started: Instant,
    /// Turns so far, and those that are left now.
    turns: u64,
    pub(super) turns_left: u64,
    /// Simulation time that it has flown to, and where its clock is, µs.
    time_us: u64,
    clock_us: u64,
    /// It rests, and need not follow its clock before this time, µs.
    rests_until_us: u64,
    /// Whether a client may wait for a long answer, and when it was asked last.
    is_answering: bool,
    asked: Instant,
    /// Why its simulation has ended before the run, if it has.
    loss: Option<Loss>,
    /// What is missing from files that have ended already, a sentence each.
    lacking: Vec<String>,
}

impl Member {
    /// A vehicle that has just started, behind the links of a hub.
    pub(super) fn new(
        participant: &Participant,
        model: Option<Box<dyn ForeignModel>>,
        speed: Speed,
        hub: usize,
        unix_start_us: u64,
    ) -> Result<Self, Failure> {
        let Participant { system_id, links, vehicle } = participant;
        let autopilot = match model {
            None => Autopilot::new(vehicle, *system_id, speed, links, unix_start_us)?,
            Some(model) => {
                let flown = Vehicle::flown_by(vehicle, model)?;
                Autopilot::of(flown, vehicle, *system_id, speed, links, unix_start_us)
            }
        };
        Ok(Self {
            autopilot: Box::new(autopilot),
            hub,
            last_heartbeat: Instant::now(),
            lockstep: None,
            radio: None,
            ground_station: None,
            digest: Digest::default(),
            parameters: None,
            plans: None,
            kept_revision: (1, 0),
            log: None,
            streamed: StreamedLog::default(),
            started: Instant::now(),
            turns: 0,
            turns_left: 0,
            time_us: 0,
            clock_us: 0,
            rests_until_us: 0,
            is_answering: true,
            asked: Instant::now(),
            loss: None,
            lacking: Vec::new(),
        })
    }

    /// Gives clients files to reach, and the flight a log.
    pub(super) fn keep(mut self, files: Box<dyn FileWorker>, log: Option<FlightLog>) -> Self {
        self.autopilot.share(files);
        self.log = log;
        self
    }

    /// Keeps its parameters and its plans in files.
    pub(super) fn remember(mut self, parameters: Option<KeptFile>, plans: Option<KeptFile>) -> Self {
        (self.parameters, self.plans) = (parameters, plans);
        self
    }

    /// Hears the pilot's radio on a port.
    pub(super) fn hear_radio(mut self, port: Option<RadioPort>) -> Self {
        self.radio = port;
        self
    }

    /// Where it hears the pilot's radio.
    pub fn radio_address(&self) -> Option<SocketAddr> {
        self.radio.as_ref().and_then(RadioPort::address)
    }

    /// Lets its simulation time wait for set-points.
    pub(super) fn keep_step(mut self, settings: Option<LockstepSettings>) -> Self {
        self.lockstep = settings.map(Lockstep::new);
        self
    }

    /// What lock-step goes by.
    pub(super) fn circumstances(&self) -> Circumstances {
        let vehicle = self.autopilot.vehicle();
        Circumstances {
            time_us: self.time_us(),
            armed: vehicle.is_armed(),
            offboard: vehicle.mode() == Mode::Offboard,
            paused: self.autopilot.speed() == Speed::Paused,
        }
    }

    /// The vehicle with its services.
    pub fn autopilot(&self) -> &Autopilot {
        &self.autopilot
    }

    /// Number of its hub.
    pub fn hub(&self) -> usize {
        self.hub
    }

    /// Its simulation time, µs: it goes on over reboots.
    pub fn time_us(&self) -> u64 {
        self.time_us
    }

    /// Simulation time by its clock, µs. One that rests may be behind it.
    pub(super) fn clock_us(&self) -> u64 {
        self.clock_us
    }

    /// Its clock has come to a time, µs. Whether it has to fly there now: `patient` lets it rest behind.
    pub(super) fn hear_clock(&mut self, clock_us: u64, patient: bool) -> bool {
        self.clock_us = clock_us;
        !patient || clock_us >= self.rests_until_us
    }

    /// Whether it rests behind its clock.
    pub(super) fn is_behind(&self) -> bool {
        self.time_us < self.clock_us
    }

    /// Ticks that it is behind its clock.
    pub(super) fn ticks_behind(&self) -> u64 {
        self.clock_us.saturating_sub(self.time_us) / TICK_US
    }

    /// It may rest behind its clock from now on, as long as it rests by itself and nobody waits for it. Logs want to see each tick.
    pub(super) fn rest(&mut self) {
        let is_awaited = self.is_answering || self.lockstep.is_some() || self.log.is_some();
        let end_us = if is_awaited { None } else { self.autopilot.rests_until_us() };
        self.rests_until_us = end_us.unwrap_or(0);
    }

    /// Something is asked of it: it follows its clock with the next tick, and there may be a long answer.
    pub(super) fn wake(&mut self) {
        (self.rests_until_us, self.is_answering) = (0, true);
    }

    /// Whether it is time to ask it for long answers. Nobody waits for one of who rests behind its clock.
    pub(super) fn is_asked(&self, now: Instant) -> bool {
        let is_time = self.is_answering || now.saturating_duration_since(self.asked) >= SELDOM;
        is_time && !self.is_behind()
    }

    /// Goes on with long answers as [`Autopilot::transfer`] does, for a turn at most. Whether it had one.
    pub(super) fn transfer(&mut self, now: Instant, has_room: impl Fn(PeerId) -> Option<bool>) -> bool {
        let turns = self.turns_left.min(1);
        self.turns_left -= turns;
        self.autopilot.transfer(turns as usize, has_room);
        (self.is_answering, self.asked) = (self.autopilot.is_answering(), now);
        turns > 0
    }

    /// Digest of its flight so far.
    pub fn digest(&self) -> Digest {
        self.digest
    }

    /// One tick on, or up to `most` at once while it hovers and nothing happens to it.
    ///
    /// # Errors
    /// [`FlightError`]: the flight cannot go on; its time is still that of the last good tick.
    pub(super) fn fly(&mut self, most: u64, now: Instant) -> Result<(), FlightError> {
        set_simulation_time(self.time_us());
        let boots = self.autopilot.boots();
        // Logs may want to see each tick.
        self.autopilot.fly(if self.log.is_some() { 1 } else { most })?;
        if self.autopilot.boots() != boots {
            // The vehicle that has booted knows of nobody.
            self.ground_station = None;
        }
        self.time_us = self.autopilot.time_us();
        self.digest.update(self.autopilot.vehicle());
        self.streamed.tick(&mut self.autopilot);
        if let Some(log) = &mut self.log {
            log.tick(&mut self.autopilot, now);
        }
        Ok(())
    }

    /// Why its simulation has ended before the run, if it has.
    pub fn loss(&self) -> Option<&Loss> {
        self.loss.as_ref()
    }

    /// Its simulation has ended: so do its files, and nothing waits for it any more.
    pub(super) fn end(&mut self, loss: Loss, now: Instant) {
        if let Some(log) = &mut self.log {
            // What its clients were told last.
            log.tick(&mut self.autopilot, now);
        }
        self.lacking = self.finish();
        (self.loss, self.lockstep, self.ground_station) = (Some(loss), None, None);
        self.clock_us = self.time_us;
    }

    /// Takes in who is there.
    pub(super) fn hear(&mut self, frame: &Frame, now: Instant) {
        if self.autopilot.shows_ground_station(frame) {
            let told = self.ground_station.is_some_and(|(_, told)| told);
            self.ground_station = Some((now, told));
        }
    }

    /// Whether a ground station is heard, if the vehicle does not know that yet.
    pub(super) fn ground_station_news(&mut self, now: Instant) -> Option<bool> {
        let (last, told) = self.ground_station.as_mut()?;
        let timeout_s = self.autopilot.vehicle().conduct().failsafe.ground_station_timeout_s;
        let heard = now.saturating_duration_since(*last).as_secs_f64() <= timeout_s;
        (std::mem::replace(told, heard) != heard).then_some(heard)
    }

    /// What is logged reaches the disk.
    pub(super) fn keep_log(&mut self, now: Instant) {
        if let Some(log) = &mut self.log {
            log.keep_up(&mut self.autopilot, now);
        }
    }

    /// Counts the turns of long answers that are due.
    pub(super) fn count_turns(&mut self, now: Instant) {
        let elapsed_s = now.saturating_duration_since(self.started).as_secs_f64();
        let due = (elapsed_s * TURNS_PER_S) as u64;
        let news = due.saturating_sub(std::mem::replace(&mut self.turns, due));
        self.turns_left = (self.turns_left + news).min(MOST_TURNS);
    }

    /// Ends its files. Returns what is missing from them, a sentence each.
    pub(super) fn finish(&mut self) -> Vec<String> {
        let mut lacking = std::mem::take(&mut self.lacking);
        if let Some(mut log) = self.log.take() {
            log.finish(&mut self.autopilot);
            lacking.append(&mut log.take_lacking());
        }
        let kept = [self.parameters.take(), self.plans.take()];
        lacking.extend(kept.into_iter().flatten().filter_map(|mut file| file.finish()));
        lacking
    }

    /// Whether its links would look dead, because simulation time is slow.
    pub(super) fn is_silent(&self, now: Instant) -> bool {
        let slow = || self.lockstep.is_some() || !matches!(self.autopilot.speed(), Speed::Max);
        now.saturating_duration_since(self.last_heartbeat) > HEARTBEAT && slow()
    }

    /// Writes its plans into their file, if one has changed.
    pub(super) fn save_plans(&mut self, now: Instant) {
        let Some(file) = &mut self.plans else { return };
        let vehicle = self.autopilot.vehicle();
        let revision = (self.autopilot.boots(), vehicle.plans_revision());
        let changed = std::mem::replace(&mut self.kept_revision, revision) != revision;
        let text = changed.then(|| render_plans(vehicle.identity(), vehicle.plans()));
        if let Some((severity, text)) = file.save(text, now) {
            self.autopilot.announce(severity, &text);
        }
    }

    /// Writes its parameters into their file, if one has changed.
    pub(super) fn save_parameters(&mut self, now: Instant) {
        let Some(file) = &mut self.parameters else { return };
        let changed = self.autopilot.take_changed_parameters(FileFormat::of(file.path()));
        if let Some((severity, text)) = file.save(changed, now) {
            self.autopilot.announce(severity, &text);
        }
    }
}
