//! Received messages take effect on the vehicles, within a budget of time, so that the flight and all that is regular go on
//! whatever comes.
//!
//! ```text
//!            poll                a turn: decode, verify,          a turn
//!   sockets ──────► an inbox ─────────────────────────────► held ────────► a vehicle
//!                   of each peer  forward, log              in lock-step
//! ```
//!
//! The turns of a hub go to its peers by the time that each has used; see [`crate::link`].

use std::time::{Duration, Instant};

use autopilot::codec::target_of;
use vehicle::Severity;

use super::signing_keeper::present;
use super::{Fleet, Member};
use crate::link::{Links, Lost, Received, SetupRules};
use crate::rarely::Rarely;
use crate::terminal::set_simulation_time;

/// What one look at the links may take; a turn that has begun then is ended.
const BUDGET: Duration = Duration::from_millis(2);
/// Of that for taking bytes from the sockets.
const POLLING: Duration = Duration::from_millis(1);
/// What the peers of one hub get before another hub is next.
const SHARE: Duration = Duration::from_micros(100);
/// Where reception goes on, and what has been told of it.
#[derive(Debug)]
pub struct Reception {
    /// The hub whose sockets are next.
    polled: usize,
    /// The hub whose peers are next.
    served: usize,
    /// The vehicle whose held messages are next.
    released: usize,
    /// What was told of each hub.
    told: Vec<Lost>,
    announced: Rarely,
}

impl Reception {
    /// Of this many hubs.
    pub fn new(hubs: usize) -> Self {
        Self {
            polled: 0,
            served: 0,
            released: 0,
            told: vec![Lost::default(); hubs],
            announced: Rarely::default(),
        }
    }
}

impl Fleet {
    /// Gives what has come to the vehicles that it is for: one, or all behind the link. What the budget is not enough for
    /// waits until the next look.
    pub(crate) fn receive(&mut self, now: Instant) {
        let start = Instant::now();
        let hubs = self.hubs.len();
        let armed = self.members.iter().any(|member| member.autopilot.vehicle().is_armed());
        let rules = SetupRules { without_key: self.accept_signing_setup, armed };
        self.hubs.iter_mut().for_each(|links| links.set_setup_rules(rules));
        self.readiness.look();
        for _ in 0..hubs {
            let hub = self.reception.polled;
            self.reception.polled = (hub + 1) % hubs;
            if let Some(links) = self.hubs.get_mut(hub) {
                links.poll(now);
            }
            if start.elapsed() >= POLLING {
                break;
            }
        }
        let timestamp = present();
        for hub in 0..hubs {
            self.keep_signing(hub, now, timestamp);
        }
        self.tell_lost(now);
        let mut idle = 0;
        while idle < hubs {
            let hub = self.reception.served;
            self.reception.served = (hub + 1) % hubs;
            idle = if self.serve(hub, now, start + BUDGET) { 0 } else { idle + 1 };
            if idle == 0 && start.elapsed() >= BUDGET {
                break;
            }
        }
    }

    /// Turns of the peers of a hub, for a share of the time. Whether there was anything to do.
    fn serve(&mut self, hub: usize, now: Instant, end: Instant) -> bool {
        // Clocks are looked at only where there is something to do: there may be hundreds of hubs.
        let is_idle = !self.keeps_step && self.hubs.get_mut(hub).is_none_or(|links| links.are_idle(now));
        if is_idle {
            return false;
        }
        let end = end.min(Instant::now() + SHARE);
        let mut served = false;
        loop {
            // What has come may only be held, and what is held may have to wait for what comes.
            let (admitted, took_effect) = (self.admit(hub, now), self.release(hub, now));
            if !admitted && !took_effect {
                return served;
            }
            served = true;
            if Instant::now() >= end {
                return true;
            }
        }
    }

    /// A turn of a peer of a hub. Whether one was due.
    fn admit(&mut self, hub: usize, now: Instant) -> bool {
        let start = Instant::now();
        let Some(links) = self.hubs.get_mut(hub) else { return false };
        let locksteps = || self.members.iter().filter(|member| member.hub == hub);
        let turn = links.take_turn(now, |peer| {
            !locksteps().any(|member| member.lockstep.as_ref().is_some_and(|step| step.is_full(peer)))
        });
        let Some(turn) = turn else { return false };
        // What signing must remember is kept before what it has accepted takes effect.
        self.keep_signing(hub, now, present());
        if let Some(received) = &turn.received {
            self.distribute(hub, received, now);
        }
        if let Some(links) = self.hubs.get_mut(hub) {
            links.charge(turn.peer, start.elapsed(), turn.received.is_some());
        }
        true
    }

    /// A message reaches the vehicles behind a hub that it is for.
    pub(super) fn distribute(&mut self, hub: usize, received: &Received, now: Instant) {
        self.books.keep_size(&self.members);
        let target = target_of(&received.frame).system;
        let is_behind_hub = |member: &&Member| member.hub == hub && member.loss().is_none();
        let takes = |member: &&Member| {
            is_behind_hub(member) && (target == 0 || target == member.autopilot.system_id())
        };
        // What they have to say up to now comes first, in the log, too.
        for number in 0..self.members.len() {
            if self.members.get(number).filter(takes).is_some() {
                self.catch_up(number, now);
            }
        }
        let Some(first) = self.members.iter().find(is_behind_hub) else { return };
        self.books.traffic(first.clock_us(), &received.frame);
        for number in 0..self.members.len() {
            if self.members.get(number).filter(takes).is_none() {
                continue;
            }
            let Some(member) = self.members.get_mut(number) else { continue };
            set_simulation_time(member.time_us());
            member.hear(&received.frame, now);
            match &mut member.lockstep {
                Some(lockstep) => lockstep.put(received.clone()),
                None => self.take_in(number, received, now),
            }
        }
    }

    /// A message that lock-step has held takes effect on a vehicle of a hub for which it is time. Whether there was one.
    fn release(&mut self, hub: usize, now: Instant) -> bool {
        let start = Instant::now();
        let members = if self.keeps_step { self.members.len() } else { 0 };
        for offset in 0..members {
            let number = (self.reception.released + offset) % members;
            let Some(member) = self.members.get_mut(number).filter(|member| member.hub == hub) else {
                continue;
            };
            let circumstances = member.circumstances();
            let held = member.lockstep.as_mut().and_then(|lockstep| lockstep.take(&circumstances));
            let Some(received) = held else { continue };
            self.reception.released = number + 1;
            self.take_in(number, &received, now);
            let lockstep = self.members.get_mut(number).and_then(|member| member.lockstep.as_mut());
            lockstep.into_iter().for_each(|step| step.charge(received.origin.peer, start.elapsed()));
            return true;
        }
        false
    }

    /// A message takes effect on a vehicle.
    pub(super) fn take_in(&mut self, number: usize, received: &Received, now: Instant) {
        let Some(member) = self.attend(number, now) else { return };
        let time_us = member.time_us();
        member.autopilot.receive(&received.origin, &received.frame);
        self.books.received(number, time_us, received);
        self.send(number, now);
    }

    /// Keeps what has changed about signing at a hub before it takes effect, and tells it to those behind it. A key is
    /// the same everywhere.
    fn keep_signing(&mut self, hub: usize, now: Instant, timestamp: u64) {
        let (Some(links), Some(keeper)) = (self.hubs.get_mut(hub), self.signing.get_mut(hub)) else {
            return;
        };
        let said = keeper.update(links, now, timestamp);
        if said.new_key {
            let key = links.signing().key().cloned();
            self.hubs.iter_mut().for_each(|links| links.signing().set_key(key.clone()));
        }
        for (severity, text) in said.lines {
            self.announce(hub, severity, &text, now);
        }
    }

    /// Says that messages were lost, if there are more than were told, and it is time.
    fn tell_lost(&mut self, now: Instant) {
        let Self { hubs, reception, .. } = self;
        let lost = hubs.iter().map(Links::lost);
        if lost.clone().eq(reception.told.iter().copied()) || !reception.announced.is_due(now) {
            return;
        }
        let lost: Vec<Lost> = lost.collect();
        let told = std::mem::replace(&mut reception.told, lost.clone());
        for (hub, (lost, told)) in lost.into_iter().zip(told).enumerate() {
            if lost != told {
                self.announce(hub, Severity::Warning, &format!("Links overloaded: {lost}"), now);
            }
        }
    }

    /// Tells something to all behind a hub.
    fn announce(&mut self, hub: usize, severity: Severity, text: &str, now: Instant) {
        for number in 0..self.members.len() {
            if self.members.get(number).is_none_or(|member| member.hub != hub) {
                continue;
            }
            let Some(member) = self.attend(number, now) else { continue };
            member.autopilot.announce(severity, text);
            self.send(number, now);
        }
    }
}
