//! All vehicles with their links: messages go to those that they are for.

use std::ops::Range;
use std::time::{Duration, Instant};

use autopilot::codec::id;
use autopilot::envelope::{Destination, Outgoing};
use vehicle::Severity;
use vehicle::foreign::ForeignModel;

use super::Member;
use super::books::Books;
use super::kept_file::KeptFile;
use super::lockstep::{Lockstep, Step};
use super::onlooker::Onlooker;
use super::reception::Reception;
use super::signing_keeper::SigningKeeper;
use crate::configuration::Settings;
use crate::failure::Failure;
use crate::files::{Disk, FileLock, FileThread, LogFolder, plans_beside};
use crate::flight_log::FlightLog;
use crate::fmu::FlownFmu;
use crate::link::{Links, Readiness};
use crate::radio_port::RadioPort;
use crate::record::Participant;

/// Longest time of one look that long answers may take.
const LONGEST_TRANSFER: Duration = Duration::from_millis(1);

/// The vehicles of a run and the hubs that they are behind.
#[derive(Debug)]
pub struct Fleet {
    pub(super) members: Vec<Member>,
    pub(super) hubs: Vec<Links>,
    /// Of their sockets.
    pub(super) readiness: Readiness,
    /// One for each hub.
    pub(super) signing: Vec<SigningKeeper>,
    /// Whether a key may be set while there is none.
    pub(super) accept_signing_setup: bool,
    pub(super) books: Books,
    pub(super) reception: Reception,
    pub(super) onlooker: Onlooker,
    /// Does the work of clients on files.
    _files: FileThread,
    /// Whether the vehicles see one another as traffic.
    pub(super) shares_traffic: bool,
    /// Whether there is lock-step.
    pub(super) keeps_step: bool,
    /// The vehicle whose long answers go on next.
    next_transfer: usize,
    /// The key's files are those of this process.
    _key_lock: Option<FileLock>,
}

impl Fleet {
    /// Opens links and files, builds the vehicles.
    ///
    /// # Errors
    /// [`Failure`] of the first thing that cannot be used.
    pub fn open(settings: &Settings, unix_start_us: u64) -> Result<Self, Failure> {
        let folder = settings.logs.folder.as_deref().map(LogFolder::open).transpose()?;
        let mut readiness = Readiness::default();
        let mut hubs: Vec<Links> = (0..)
            .zip(&settings.hubs)
            .map(|(hub, links)| {
                let behind = settings.vehicles.iter().filter(|vehicle| vehicle.hub == hub);
                Links::open(links, behind.map(|vehicle| vehicle.system_id).collect(), &mut readiness)
            })
            .collect::<Result<_, _>>()?;
        let key = settings.signing_key.as_deref();
        let key_lock = key.filter(|path| path.exists()).map(FileLock::claim).transpose()?.flatten();
        let signing = hubs
            .iter_mut()
            .enumerate()
            .map(|(hub, links)| SigningKeeper::new(key, hub, settings.accept_signing_setup, links))
            .collect::<Result<_, _>>()?;
        // A port that is taken belongs to somebody whose files these may be, too: they come after the links.
        let mut participants = settings.participants();
        // An FMU that does not start leaves no files behind.
        let mut models = start_models(settings, &mut participants)?.into_iter();
        let books = Books::open(settings, participants.clone(), unix_start_us)?;
        // The vehicles last: they introduce themselves, and then nothing is in the way any more.
        let files = FileThread::new(Disk::open(folder.as_ref(), settings.ftp_root.as_ref())?);
        let members = (0..)
            .zip(participants.iter().zip(&settings.vehicles))
            .map(|(number, (participant, own))| {
                let parameters = own.parameters.as_deref().map(KeptFile::of_parameters).transpose()?;
                let plans = own.parameters.as_deref().map(|path| KeptFile::of_plans(&plans_beside(path)));
                let model = models.next().flatten();
                let member = Member::new(participant, model, settings.speed, own.hub, unix_start_us)?;
                let log = folder.clone().map(|folder| FlightLog::new(folder, settings.logs.clone()));
                let member = member.hear_radio(own.rc_port.map(RadioPort::open).transpose()?);
                Ok(member
                    .keep(files.desk(number), log)
                    .remember(parameters, plans)
                    .keep_step(settings.lockstep))
            })
            .collect::<Result<Vec<_>, Failure>>()?;
        Ok(Self {
            members,
            signing,
            accept_signing_setup: settings.accept_signing_setup,
            books,
            reception: Reception::new(hubs.len()),
            onlooker: Onlooker::default(),
            hubs,
            readiness,
            _files: files,
            shares_traffic: settings.fleet_traffic,
            keeps_step: settings.lockstep.is_some(),
            next_transfer: 0,
            _key_lock: key_lock,
        })
    }

    /// The vehicles.
    pub fn members(&self) -> &[Member] {
        &self.members
    }

    /// Simulation time by the clock that is furthest, µs.
    pub fn time_us(&self) -> u64 {
        self.members.iter().map(Member::clock_us).max().unwrap_or(0)
    }

    /// The links.
    pub fn hubs(&self) -> &[Links] {
        &self.hubs
    }

    /// Simulation time that lock-step lets these vehicles reach now, µs.
    pub(super) fn limit_us(&self, members: Range<usize>) -> u64 {
        let members = self.members.get(members).unwrap_or_default();
        let limits = members.iter().filter_map(|member| member.lockstep.as_ref()?.limit_us());
        limits.min().unwrap_or(u64::MAX)
    }

    /// Tells clients that a vehicle waits for where it is, and gives up those that are gone. Whether a set-point can be
    /// expected at any moment.
    pub(crate) fn keep_in_step(&mut self, now: Instant) -> bool {
        let mut expected = false;
        let members = if self.keeps_step { self.members.len() } else { 0 };
        for number in 0..members {
            let Some(member) = self.members.get_mut(number) else { continue };
            let circumstances = member.circumstances();
            let Some(lockstep) = &mut member.lockstep else { continue };
            let hub = self.hubs.get(member.hub);
            let connected = lockstep
                .client()
                .is_none_or(|client| hub.is_some_and(|links| links.has_room(client).is_some()));
            let timeout_s = lockstep.timeout().as_secs_f64();
            match lockstep.step(&circumstances, now, connected) {
                Step::Fly | Step::Wait => continue,
                Step::Expect => expected = true,
                Step::Report(client) => {
                    expected = true;
                    member.autopilot.report(id::LOCAL_POSITION_NED, client);
                }
                Step::GiveUp => {
                    let reason = if connected {
                        format!("no set-point for {timeout_s} s")
                    } else {
                        "client disconnected".to_owned()
                    };
                    let system = member.autopilot.system_id();
                    tracing::warn!(
                        "system {system}: lock-step suspended ({reason}); the next set-point resumes it"
                    );
                    member.autopilot.announce(Severity::Warning, &format!("Lock-step suspended: {reason}"));
                }
            }
            self.send(number, now);
        }
        expected
    }

    /// Sends what a vehicle has to say. A changed parameter is in the file before anybody hears of it.
    /// Returns whether there was anything.
    pub(super) fn send(&mut self, number: usize, now: Instant) -> bool {
        let Some(member) = self.members.get_mut(number) else { return false };
        if member.loss().is_some() {
            // Nobody hears of it any more.
            drop(member.autopilot.take_outgoing());
            return false;
        }
        member.save_parameters(now);
        member.save_plans(now);
        let Some(links) = self.hubs.get_mut(member.hub) else { return false };
        let (time_us, system) = (member.time_us(), member.autopilot.system_id());
        // Looked at where they are: they are large.
        let all = member.autopilot.take_outgoing();
        let any = all.len() > 0;
        for outgoing in all.as_slice() {
            if outgoing.message.id() == id::HEARTBEAT {
                member.last_heartbeat = now;
            }
            if let Some(lockstep) = &mut member.lockstep
                && reports_to_client(outgoing, lockstep)
            {
                lockstep.has_reported();
            }
            self.onlooker.hear(system, time_us, outgoing);
            if let Some(frame) = links.send(outgoing, system) {
                self.books.traffic(time_us, frame);
            }
        }
        any
    }

    /// Hands what the pilots' radios send on to their vehicles.
    pub(crate) fn hear_radios(&mut self, now: Instant) {
        for number in 0..self.members.len() {
            let radio = self.members.get_mut(number).and_then(|member| member.radio.as_mut());
            let Some(pulses) = radio.and_then(RadioPort::news) else { continue };
            if let Some(member) = self.attend(number, now) {
                let time_us = member.time_us();
                member.autopilot.receive_radio(pulses);
                self.books.radio(number, time_us, &pulses);
            }
        }
    }

    /// Heartbeats where simulation time is too slow for them, and who is heard no more. Whoever rests behind its clock is looked at when it
    /// has flown there.
    pub(crate) fn keep_links_alive(&mut self, now: Instant) {
        for number in 0..self.members.len() {
            let Some(member) = self.members.get_mut(number).filter(|member| !member.is_behind()) else {
                continue;
            };
            if let Some(heard) = member.ground_station_news(now) {
                self.books.ground_station(number, member.time_us(), heard);
                member.autopilot.hear_ground_station(heard);
                member.wake();
            }
            if member.is_silent(now) {
                member.autopilot.keep_alive();
                self.send(number, now);
            }
        }
    }

    /// What is logged reaches the disk.
    pub(crate) fn keep_logs(&mut self, now: Instant) {
        for (severity, text) in self.books.keep_up(now) {
            for number in 0..self.members.len() {
                let Some(member) = self.attend(number, now) else { continue };
                member.autopilot.announce(severity, &text);
                self.send(number, now);
            }
        }
        self.members.iter_mut().for_each(|member| member.keep_log(now));
    }

    /// Goes on with long answers: lists, downloads, files. All vehicles together get a small share of the time.
    pub(crate) fn transfer(&mut self, now: Instant) {
        let start = Instant::now();
        self.members.iter_mut().for_each(|member| member.count_turns(now));
        let mut idle = 0;
        // Whoever has nothing to send is asked once, too, if it is time: it hears who is gone, and takes in what the disk has answered.
        while idle < self.members.len() {
            let number = self.next_transfer % self.members.len();
            self.next_transfer = number + 1;
            let (Some(member), hubs) = (self.members.get_mut(number), &self.hubs) else { return };
            if !member.is_asked(now) {
                idle += 1;
                continue;
            }
            let links = hubs.get(member.hub);
            let had_turn = member.transfer(now, |peer| links.and_then(|links| links.has_room(peer)));
            idle = if self.send(number, now) && had_turn { 0 } else { idle + 1 };
            if start.elapsed() > LONGEST_TRANSFER {
                return;
            }
        }
        // Turns that nobody needs are not saved up.
        self.members.iter_mut().for_each(|member| member.turns_left = 0);
    }

    /// Sends what waits in the links.
    pub(crate) fn flush(&mut self) {
        self.hubs.iter_mut().for_each(Links::flush);
    }

    /// Ends the files. Returns the vehicles as they are, and what is missing from the files, a sentence each.
    pub(crate) fn finish(mut self, now: Instant) -> (Vec<Member>, Vec<String>) {
        self.catch_up_all(now);
        self.flush();
        let mut lacking: Vec<String> = self.members.iter_mut().flat_map(Member::finish).collect();
        for (keeper, links) in self.signing.iter_mut().zip(&mut self.hubs) {
            lacking.append(&mut keeper.finish(links));
        }
        lacking.append(&mut self.books.finish(&self.members));
        (self.members, lacking)
    }
}

/// Starts an FMU for each vehicle that is flown by one, and notes in the participants how they start.
fn start_models(
    settings: &Settings,
    participants: &mut [Participant],
) -> Result<Vec<Option<Box<dyn ForeignModel>>>, Failure> {
    let start = |participant: &mut Participant| {
        let Some(choice) = &settings.fmu else { return Ok(None) };
        let name = format!("system {}", participant.system_id);
        let model = FlownFmu::start(choice, &name, &participant.vehicle, 0.0)?;
        participant.vehicle.foreign = Some(model.description().clone());
        let model: Box<dyn ForeignModel> = Box::new(model);
        Ok(Some(model))
    };
    participants.iter_mut().map(start).collect()
}

/// Whether a message tells the client of lock-step where the vehicle is.
fn reports_to_client(outgoing: &Outgoing, lockstep: &Lockstep) -> bool {
    outgoing.message.id() == id::LOCAL_POSITION_NED
        && lockstep.client().is_some_and(|client| match outgoing.to {
            Destination::Everyone => true,
            Destination::Link(link) => link == client.link,
            Destination::Peer(peer) => peer == client,
        })
}
