//! The messages of one link with their intervals, and who wants them.

use vehicle::TICK_US;

use crate::envelope::{LinkProfile, PeerId};
use crate::stream::Stream;

/// Longest interval, µs: what MESSAGE_INTERVAL can tell.
const LONGEST_US: u64 = i32::MAX as u64;

/// A message that a link gets regularly.
#[derive(Clone, Copy, Debug)]
struct Regular {
    stream: &'static Stream,
    interval_us: u64,
    due_us: u64,
}

/// An interval that a peer has asked for; `None`: never.
#[derive(Clone, Copy, Debug)]
struct Wish {
    peer: PeerId,
    stream: &'static Stream,
    interval_us: Option<u64>,
}

/// The messages of one link, in the order in which they were asked for. The latest wish for a message counts, as long as whoever has it
/// is there.
#[derive(Clone, Debug, Default)]
pub struct Schedule {
    profile: LinkProfile,
    regular: Vec<Regular>,
    wishes: Vec<Wish>,
}

impl Schedule {
    /// The messages that a link of this profile gets at the start.
    pub fn new(profile: LinkProfile, streams: impl Iterator<Item = &'static Stream>, time_us: u64) -> Self {
        let mut schedule = Self { profile, ..Self::default() };
        for stream in streams {
            schedule.apply(stream, stream.default_interval_us(profile), time_us);
        }
        schedule
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

    /// A peer wants a message at an interval, µs, or never.
    pub fn set(&mut self, peer: PeerId, stream: &'static Stream, interval_us: Option<u64>, time_us: u64) {
        self.wishes.retain(|wish| (wish.peer, wish.stream.id) != (peer, stream.id));
        self.wishes.push(Wish { peer, stream, interval_us });
        self.apply(stream, interval_us, time_us);
    }

    /// Forgets what peers wanted that are gone: what others want counts again, or the rate at the start.
    pub fn forget(&mut self, is_gone: impl Fn(PeerId) -> bool, time_us: u64) {
        let (gone, wishes) =
            std::mem::take(&mut self.wishes).into_iter().partition(|wish| is_gone(wish.peer));
        self.wishes = wishes;
        let gone: Vec<Wish> = gone;
        for Wish { stream, .. } in gone {
            let latest = self.wishes.iter().rfind(|wish| wish.stream.id == stream.id);
            let interval_us =
                latest.map_or_else(|| stream.default_interval_us(self.profile), |wish| wish.interval_us);
            if interval_us.map(allowed) != self.interval_us(stream.id) {
                self.apply(stream, interval_us, time_us);
            }
        }
    }

    fn apply(&mut self, stream: &'static Stream, interval_us: Option<u64>, time_us: u64) {
        self.regular.retain(|regular| regular.stream.id != stream.id);
        if let Some(interval_us) = interval_us.map(allowed) {
            self.regular.push(Regular { stream, interval_us, due_us: time_us });
        }
    }

    /// Messages that are due. Their times are multiples of the interval, so that a rate holds exactly on average.
    pub fn due(&mut self, time_us: u64, mut send: impl FnMut(&'static Stream)) {
        for regular in self.regular.iter_mut().filter(|regular| regular.due_us <= time_us) {
            send(regular.stream);
            regular.due_us += regular.interval_us;
            if regular.due_us <= time_us {
                regular.due_us = time_us + regular.interval_us;
            }
        }
    }
}

/// The nearest interval that can be kept, µs.
fn allowed(interval_us: u64) -> u64 {
    interval_us.clamp(TICK_US, LONGEST_US)
}
