//! All vehicles with their links: messages go to those that they are for.

use std::ops::Range;
use std::time::Instant;

use autopilot::codec::{id, target_of};
use autopilot::envelope::{Destination, Outgoing};
use vehicle::Severity;

use super::Member;
use super::books::Books;
use super::lockstep::{Lockstep, Step};
use super::parameter_file::ParameterFile;
use super::signing_keeper::SigningKeeper;
use crate::configuration::Settings;
use crate::failure::Failure;
use crate::files::{Disk, FileLock, LogFolder};
use crate::flight_log::FlightLog;
use crate::link::{Links, Received};
use crate::terminal::set_simulation_time;

/// The vehicles of a run and the hubs that they are behind.
#[derive(Debug)]
pub struct Fleet {
    pub(super) members: Vec<Member>,
    hubs: Vec<Links>,
    /// One for each hub.
    signing: Vec<SigningKeeper>,
    pub(super) books: Books,
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
        let mut hubs: Vec<Links> = (0..)
            .zip(&settings.hubs)
            .map(|(hub, links)| {
                let behind = settings.vehicles.iter().filter(|vehicle| vehicle.hub == hub);
                Links::open(links, behind.map(|vehicle| vehicle.system_id).collect())
            })
            .collect::<Result<_, _>>()?;
        let key = settings.signing_key.as_deref();
        let key_lock = key.filter(|path| path.exists()).map(FileLock::claim).transpose()?.flatten();
        let signing = hubs
            .iter_mut()
            .enumerate()
            .map(|(hub, links)| SigningKeeper::new(key, hub, unix_start_us, links))
            .collect::<Result<_, _>>()?;
        // A port that is taken belongs to somebody whose files these may be, too: they come after the links.
        let participants = settings.participants();
        let books = Books::open(settings, participants.clone(), unix_start_us)?;
        // The vehicles last: they introduce themselves, and then nothing is in the way any more.
        let members = participants
            .iter()
            .zip(&settings.vehicles)
            .map(|(participant, own)| {
                let files = Disk::open(folder.as_ref(), settings.ftp_root.as_ref())?;
                let parameters = own.parameters.as_deref().map(ParameterFile::open).transpose()?;
                let member = Member::new(participant, settings.speed, own.hub, parameters, unix_start_us)?;
                let log = folder.clone().map(|folder| FlightLog::new(folder, settings.logs.clone()));
                Ok(member.keep(files, log).keep_step(settings.lockstep))
            })
            .collect::<Result<Vec<_>, Failure>>()?;
        Ok(Self { members, hubs, signing, books, _key_lock: key_lock })
    }

    /// The vehicles.
    pub fn members(&self) -> &[Member] {
        &self.members
    }

    /// Simulation time of the vehicle that is furthest, µs.
    pub fn time_us(&self) -> u64 {
        self.members.iter().map(Member::time_us).max().unwrap_or(0)
    }

    /// The links.
    pub fn hubs(&self) -> &[Links] {
        &self.hubs
    }

    /// Gives everything that has come to the vehicles that it is for: one, or all behind the link.
    pub(crate) fn receive(&mut self, now: Instant) {
        for hub in 0..self.hubs.len() {
            let Some(links) = self.hubs.get_mut(hub) else { continue };
            let received = links.receive(now);
            self.keep_signing(hub, now);
            for received in received {
                self.books.keep_size(&self.members);
                let target = target_of(&received.frame).system;
                let mut logged = false;
                for number in 0..self.members.len() {
                    let heard = |member: &&mut Member| member.hub == hub && member.loss().is_none();
                    let Some(member) = self.members.get_mut(number).filter(heard) else { continue };
                    let time_us = member.time_us();
                    set_simulation_time(time_us);
                    if !std::mem::replace(&mut logged, true) {
                        self.books.traffic(time_us, &received.frame);
                    }
                    if target == 0 || target == member.autopilot.system_id() {
                        member.hear(&received.frame, now);
                        match &mut member.lockstep {
                            Some(lockstep) => lockstep.put(received.clone()),
                            None => self.take_in(number, &received, now),
                        }
                    }
                }
            }
        }
        self.take_held(now);
    }

    /// A message takes effect on a vehicle.
    fn take_in(&mut self, number: usize, received: &Received, now: Instant) {
        let Some(member) = self.members.get_mut(number) else { return };
        self.books.received(number, member.time_us(), received);
        member.autopilot.receive(&received.origin, &received.frame);
        self.send(number, now);
    }

    /// Messages that lock-step has held take effect if it is time.
    fn take_held(&mut self, now: Instant) {
        for number in 0..self.members.len() {
            while let Some(received) = self.members.get_mut(number).and_then(|member| {
                let circumstances = member.circumstances();
                member.lockstep.as_mut()?.take(&circumstances)
            }) {
                self.take_in(number, &received, now);
            }
        }
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
        for number in 0..self.members.len() {
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

    /// Keeps what has changed about signing at a hub before it takes effect, and tells it to those behind it. A key is
    /// the same everywhere.
    fn keep_signing(&mut self, hub: usize, now: Instant) {
        let (Some(links), Some(keeper)) = (self.hubs.get_mut(hub), self.signing.get_mut(hub)) else {
            return;
        };
        let said = keeper.update(links, now);
        if said.new_key {
            let key = links.signing().key().cloned();
            self.hubs.iter_mut().for_each(|links| links.signing().set_key(key.clone(), 0));
        }
        for (severity, text) in said.lines {
            for number in 0..self.members.len() {
                let Some(member) = self.members.get_mut(number).filter(|member| member.hub == hub) else {
                    continue;
                };
                member.autopilot.announce(severity, &text);
                self.send(number, now);
            }
        }
    }

    /// A tick of one vehicle, unless its simulation has ended.
    pub(super) fn tick(&mut self, number: usize, now: Instant) {
        let flying = |member: &&mut Member| member.loss().is_none();
        let Some(member) = self.members.get_mut(number).filter(flying) else { return };
        match member.tick(now) {
            Ok(()) => self.send(number, now),
            Err(error) => self.lose(number, error, now),
        }
    }

    pub(super) fn member_mut(&mut self, number: usize) -> Option<&mut Member> {
        self.members.get_mut(number)
    }

    /// Sends what a vehicle has to say. A changed parameter is in the file before anybody hears of it.
    pub(super) fn send(&mut self, number: usize, now: Instant) {
        let Some(member) = self.members.get_mut(number) else { return };
        if member.loss().is_some() {
            // Nobody hears of it any more.
            drop(member.autopilot.take_outgoing());
            return;
        }
        member.save_parameters(now);
        let Some(links) = self.hubs.get_mut(member.hub) else { return };
        for outgoing in member.autopilot.take_outgoing() {
            if outgoing.message.id() == id::HEARTBEAT {
                member.last_heartbeat = now;
            }
            if let Some(lockstep) = &mut member.lockstep
                && reports_to_client(&outgoing, lockstep)
            {
                lockstep.has_reported();
            }
            if let Some(frame) = links.send(&outgoing, member.autopilot.system_id()) {
                self.books.traffic(member.time_us(), &frame);
            }
        }
    }

    /// Heartbeats where simulation time is too slow for them.
    pub(crate) fn keep_links_alive(&mut self, now: Instant) {
        for number in 0..self.members.len() {
            let Some(member) = self.members.get_mut(number) else { continue };
            if let Some(heard) = member.ground_station_news(now) {
                self.books.ground_station(number, member.time_us(), heard);
                member.autopilot.hear_ground_station(heard);
            }
            if member.is_silent(now) {
                member.autopilot.keep_alive();
                self.send(number, now);
            }
        }
    }

    /// What is logged reaches the disk, and what is downloaded the links.
    pub(crate) fn keep_logs(&mut self, now: Instant) {
        for (severity, text) in self.books.keep_up(&self.members, now) {
            for number in 0..self.members.len() {
                let Some(member) = self.members.get_mut(number) else { continue };
                member.autopilot.announce(severity, &text);
                self.send(number, now);
            }
        }
        for number in 0..self.members.len() {
            let Some(member) = self.members.get_mut(number) else { continue };
            for _ in 0..member.keep_log(now) {
                let (Some(member), hubs) = (self.members.get_mut(number), &self.hubs) else { break };
                let hub = member.hub;
                member.autopilot.send_logs(1, |peer| hubs.get(hub).and_then(|links| links.has_room(peer)));
                self.send(number, now);
            }
        }
    }

    /// Sends what waits in the links.
    pub(crate) fn flush(&mut self) {
        self.hubs.iter_mut().for_each(Links::flush);
    }

    /// Ends the files. Returns the vehicles as they are, and what is missing from the files, a sentence each.
    pub(crate) fn finish(mut self) -> (Vec<Member>, Vec<String>) {
        let mut lacking: Vec<String> = self.members.iter_mut().flat_map(Member::finish).collect();
        for (keeper, links) in self.signing.iter_mut().zip(&mut self.hubs) {
            lacking.append(&mut keeper.finish(links));
        }
        lacking.append(&mut self.books.finish(&self.members));
        (self.members, lacking)
    }
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
