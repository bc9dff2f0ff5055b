//! The messages of one link with their intervals, and who wants them.

use vehicle::{GroupRates, TICK_US};

use crate::envelope::{LinkProfile, PeerId};
use crate::stream::{Group, Stream};

/// Longest interval, µs: what MESSAGE_INTERVAL can tell.
const LONGEST_US: u64 = i32::MAX as u64;

/// A message that a link gets regularly.
#[derive(Clone, Copy, Debug)]
struct Regular {
    stream: &'static Stream,
    interval_us: u64,
    due_us: u64,
}

/// An interval that a peer has asked for.
#[derive(Clone, Copy, Debug)]
struct Wish {
    peer: PeerId,
    stream: &'static Stream,
    interval: Interval,
}

/// How often a message is to be sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interval {
    /// As often as if nobody asked.
    Default,
    /// Every so many µs.
    Each(u64),
    /// Never.
    Never,
}

/// The messages of one link, in the order in which they were asked for. The latest wish for a message counts, as long as whoever has it
/// is there.
#[derive(Clone, Debug, Default)]
pub struct Schedule {
    profile: LinkProfile,
    rates: GroupRates,
    regular: Vec<Regular>,
    wishes: Vec<Wish>,
    /// No message is due before this time, µs.
    quiet_until_us: u64,
}

impl Schedule {
    /// The messages that a link of this profile gets at the start, where the rates of their groups say nothing else.
    pub fn new(
        profile: LinkProfile,
        rates: GroupRates,
        streams: impl Iterator<Item = &'static Stream>,
        time_us: u64,
    ) -> Self {
        let mut schedule = Self { profile, rates, ..Self::default() };
        for stream in streams {
            schedule.apply(stream, schedule.default_interval_us(stream), time_us);
        }
        schedule
    }

    /// Interval of a message that nobody has asked for, µs; `None`: it is not sent.
    pub fn default_interval_us(&self, stream: &Stream) -> Option<u64> {
        match stream.group.and_then(|group| rate_hz(&self.rates, group)) {
            Some(0) => None,
            Some(rate_hz) => Some(1_000_000 / u64::from(rate_hz)),
            None => stream.default_interval_us(self.profile),
        }
    }

    /// Other rates of groups hold for what nobody has asked for.
    pub fn change_rates(
        &mut self,
        rates: GroupRates,
        streams: impl Iterator<Item = &'static Stream>,
        time_us: u64,
    ) {
        let before = std::mem::replace(&mut self.rates, rates);
        for stream in streams {
            let is_other = |group| rate_hz(&before, group) != rate_hz(&rates, group);
            if stream.group.is_some_and(is_other) && self.wish(stream) == Interval::Default {
                self.apply(stream, self.default_interval_us(stream), time_us);
            }
        }
    }

    /// Interval of a message, µs, if the link gets it.
    pub fn interval_us(&self, id: u32) -> Option<u64> {
        self.regular.iter().find(|regular| regular.stream.id == id).map(|regular| regular.interval_us)
    }

    /// Messages per second of simulation if one had this interval.
    pub fn per_s_with(&self, stream: &Stream, interval_us: Option<u64>) -> f64 {
        let others = self.regular.iter().filter(|regular| regular.stream.id != stream.id);
        let intervals_us = others.map(|regular| regular.interval_us).chain(interval_us.map(allowed));
        intervals_us.map(|interval_us| 1e6 / interval_us as f64).sum()
    }

    /// The latest wish for a message.
    fn wish(&self, stream: &Stream) -> Interval {
        let latest = self.wishes.iter().rfind(|wish| wish.stream.id == stream.id);
        latest.map_or(Interval::Default, |wish| wish.interval)
    }

    /// The interval that a wish stands for now, µs; `None`: never.
    pub fn resolved_us(&self, stream: &Stream, interval: Interval) -> Option<u64> {
        match interval {
            Interval::Default => self.default_interval_us(stream),
            Interval::Each(interval_us) => Some(interval_us),
            Interval::Never => None,
        }
    }

    /// A peer wants a message at an interval.
    pub fn set(&mut self, peer: PeerId, stream: &'static Stream, interval: Interval, time_us: u64) {
        self.wishes.retain(|wish| (wish.peer, wish.stream.id) != (peer, stream.id));
        self.wishes.push(Wish { peer, stream, interval });
        self.apply(stream, self.resolved_us(stream, interval), time_us);
    }

    /// Forgets what peers wanted that are gone: what others want counts again, or the rate at the start.
    pub fn forget(&mut self, is_gone: impl Fn(PeerId) -> bool, time_us: u64) {
        let (gone, wishes) =
            std::mem::take(&mut self.wishes).into_iter().partition(|wish| is_gone(wish.peer));
        self.wishes = wishes;
        let gone: Vec<Wish> = gone;
        for Wish { stream, .. } in gone {
            let interval_us = self.resolved_us(stream, self.wish(stream));
            if interval_us.map(allowed) != self.interval_us(stream.id) {
                self.apply(stream, interval_us, time_us);
            }
        }
    }

    fn apply(&mut self, stream: &'static Stream, interval_us: Option<u64>, time_us: u64) {
        self.regular.retain(|regular| regular.stream.id != stream.id);
        if let Some(interval_us) = interval_us.map(allowed) {
            self.regular.push(Regular { stream, interval_us, due_us: time_us });
            self.quiet_until_us = self.quiet_until_us.min(time_us);
        }
    }

    /// No message is due before this time, µs.
    pub fn quiet_until_us(&self) -> u64 {
        self.quiet_until_us
    }

    /// Messages that are due. Their times are multiples of the interval, so that a rate holds exactly on average.
    pub fn due(&mut self, time_us: u64, mut send: impl FnMut(&'static Stream)) {
        if time_us < self.quiet_until_us {
            return;
        }
        for regular in self.regular.iter_mut().filter(|regular| regular.due_us <= time_us) {
            send(regular.stream);
            regular.due_us += regular.interval_us;
            if regular.due_us <= time_us {
                regular.due_us = time_us + regular.interval_us;
            }
        }
        self.quiet_until_us = self.regular.iter().map(|regular| regular.due_us).min().unwrap_or(u64::MAX);
    }
}

/// The rate that a parameter gives a group, Hz.
fn rate_hz(rates: &GroupRates, group: Group) -> Option<u8> {
    match group {
        Group::RawSensors => rates.raw_sensors,
        Group::ExtendedStatus => rates.extended_status,
        Group::RcChannels => rates.rc_channels,
        Group::Position => rates.position,
        Group::Extra1 => rates.extra1,
        Group::Extra2 => rates.extra2,
        Group::Extra3 => rates.extra3,
    }
}

/// The nearest interval that can be kept, µs.
fn allowed(interval_us: u64) -> u64 {
    interval_us.clamp(TICK_US, LONGEST_US)
}

#[cfg(test)]
mod tests {
    use mavlink::dialects::ardupilotmega::{MavMessage, SYSTEM_TIME_DATA};
    use vehicle::GroupRates;

    use super::{Interval, Schedule};
    use crate::envelope::{LinkProfile, PeerId};
    use crate::stream::Stream;

    static SLOW: Stream =
        Stream::new(1, [1.0, 1.0], |_| MavMessage::SYSTEM_TIME(SYSTEM_TIME_DATA::default()));
    static ASKED: Stream =
        Stream::new(2, [0.0, 0.0], |_| MavMessage::SYSTEM_TIME(SYSTEM_TIME_DATA::default()));

    /// One that is asked for while all others rest is sent at once, and then at its own pace.
    #[test]
    fn a_new_message_does_not_wait_for_the_others() {
        let peer = PeerId { link: 0, number: 1 };
        let mut schedule = Schedule::new(LinkProfile::Ground, GroupRates::default(), [&SLOW].into_iter(), 0);
        let mut sent = Vec::new();
        for time_us in (0..2_000_000).step_by(100_000) {
            if time_us == 300_000 {
                schedule.set(peer, &ASKED, Interval::Each(500_000), time_us);
            }
            schedule.due(time_us, |stream| sent.push((stream.id, time_us / 100_000)));
        }
        assert_eq!(sent, [(1, 0), (2, 3), (2, 8), (1, 10), (2, 13), (2, 18)]);
    }
}
