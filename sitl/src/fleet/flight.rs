//! Vehicles follow their clocks. One that rests may be behind its clock, until a regular message is due or by 50 ms: it is flown on
//! before anything is handed in to it and before anybody looks at it, so that all is as if it had been flown each tick, and only what it
//! tells leaves later.
//!
//! ```text
//!   clock, ms          20    25    30    35    40    45
//!   nobody asks        ├─────────────────────────────┤   flown at 45, when a message is due: a long tick and a part of the next
//!   a message at 32    ├─────────────┼┼──────────────┤   flown to 32 before it takes effect, then at 33, and at 45
//! ```

use std::ops::Range;
use std::time::Instant;

use autopilot::COMPONENT;
use autopilot::codec::{Frame, Version};
use autopilot::envelope::{Origin, PeerId};
use vehicle::TICK_US;

use super::{Fleet, Member};
use crate::link::Received;

impl Fleet {
    /// The clock of some vehicles goes on from one time to another, µs, and they fly: one after the other, so that its state stays in the caches
    /// of the processor. Those that see one another fly tick by tick. `patient` lets those that rest stay behind.
    pub(super) fn fly(&mut self, members: Range<usize>, span_us: Range<u64>, patient: bool, now: Instant) {
        let round_us = if self.shares_traffic { TICK_US } else { u64::MAX };
        let patient = patient && !self.shares_traffic;
        let mut clock_us = span_us.start;
        while clock_us < span_us.end {
            clock_us = clock_us.saturating_add(round_us).min(span_us.end);
            members.clone().for_each(|number| self.follow_clock(number, clock_us, patient, now));
        }
    }

    /// The clock of a vehicle has come to a time, µs.
    fn follow_clock(&mut self, number: usize, clock_us: u64, patient: bool, now: Instant) {
        let flying = |member: &&mut Member| member.loss().is_none();
        let Some(member) = self.members.get_mut(number).filter(flying) else { return };
        if !member.hear_clock(clock_us, patient) {
            return;
        }
        self.catch_up(number, now);
        if let Some(member) = self.members.get_mut(number).filter(|_| patient) {
            member.rest();
        }
    }

    /// Flies a vehicle on to where its clock is.
    pub(crate) fn catch_up(&mut self, number: usize, now: Instant) {
        while let Some(behind) = self.members.get(number).map(Member::ticks_behind).filter(|ticks| *ticks > 0)
        {
            self.fly_member(number, behind, now);
        }
    }

    /// Flies all on to where their clocks are: somebody looks at them.
    pub(crate) fn catch_up_all(&mut self, now: Instant) {
        (0..self.members.len()).for_each(|number| self.catch_up(number, now));
    }

    /// A vehicle that something is handed in to: where its clock is, and awake. `None`: its simulation has ended.
    pub(super) fn attend(&mut self, number: usize, now: Instant) -> Option<&mut Member> {
        self.catch_up(number, now);
        let member = self.members.get_mut(number).filter(|member| member.loss().is_none())?;
        member.wake();
        Some(member)
    }

    /// A tick of one vehicle, or up to `most` at once where nothing happens in between.
    pub(super) fn fly_member(&mut self, number: usize, most: u64, now: Instant) {
        let flying = |member: &&mut Member| member.loss().is_none();
        let Some(member) = self.members.get_mut(number).filter(flying) else { return };
        let begun_us = member.time_us();
        match member.fly(self.books.ticks_to_state(begun_us, most), now) {
            Ok(()) => {
                if let Some(motion) = member.autopilot.vehicle().foreign_motion() {
                    self.books.motion(number, begun_us, motion);
                }
                self.books.flown(number, member);
                self.books.keep_size(&self.members);
                self.send(number, now);
                self.share_traffic(number, now);
            }
            Err(error) => self.lose(number, error, now),
        }
    }

    /// Once a second the others hear the transponder of a vehicle, as if it had been received: records hold it.
    fn share_traffic(&mut self, number: usize, now: Instant) {
        const PERIOD_US: u64 = 1_000_000;
        let Some(member) = self.members.get(number).filter(|_| self.shares_traffic) else { return };
        if !member.time_us().is_multiple_of(PERIOD_US) {
            return;
        }
        let system = member.autopilot.system_id();
        let sequence = (member.time_us() / PERIOD_US) as u8;
        let report = member.autopilot.transponder_report();
        let Some(frame) = Frame::encode(&report, Version::Two, sequence, (system, COMPONENT)) else { return };
        let peer = PeerId { link: 0, number: u64::MAX };
        let received = Received { origin: Origin { peer, system, component: COMPONENT }, frame };
        for other in (0..self.members.len()).filter(|other| *other != number) {
            if self.members.get(other).is_some_and(|member| member.loss().is_none()) {
                self.take_in(other, &received, now);
            }
        }
    }
}
