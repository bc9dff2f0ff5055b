//! The latest timestamp of each sender's stream, in bounded memory.

use std::collections::BTreeMap;

use super::guard::Refusal;
use super::kept::Stream;

/// Streams that are remembered.
pub const MOST_STREAMS: usize = 1024;
/// A new stream may begin this far behind the clock, units of 10 µs: a minute, as MAVLink specifies.
pub const NEW_STREAM_BEHIND: u64 = 6_000_000;
/// Timestamps are kept this far ahead of those in use, so that not every frame is a write: a second.
pub const KEPT_AHEAD: u64 = 100_000;

/// Timestamps of one stream.
#[derive(Clone, Copy, Debug)]
struct Seen {
    last: u64,
    /// As it is in the file.
    kept: u64,
    /// Frames accepted in this run.
    frames: u32,
}

/// Streams and their latest timestamps.
///
/// No frame that was accepted is accepted again, whatever the clock does: either its stream is remembered, or its timestamp is
/// not beyond that of the latest stream that was forgotten. A stream is forgotten only to make room for a new one: those too old
/// to begin again first, then that with the fewest frames, so that invented streams do not displace those in use.
#[derive(Clone, Debug, Default)]
pub struct Streams {
    seen: BTreeMap<Stream, Seen>,
    /// Nothing that was accepted of a forgotten stream has a later timestamp.
    forgotten: u64,
}

impl Streams {
    /// As they were kept: the latest timestamp of each, and that of all forgotten ones.
    pub fn new(last: BTreeMap<Stream, u64>, forgotten: u64) -> Self {
        let seen = |last| Seen { last, kept: last, frames: 0 };
        Self { seen: last.into_iter().map(|(stream, last)| (stream, seen(last))).collect(), forgotten }
    }

    /// Accepts a frame of a stream. Returns whether the file must change for it.
    ///
    /// # Errors
    /// [`Refusal::Replayed`] or [`Refusal::Late`], which change nothing.
    pub fn accept(&mut self, stream: Stream, timestamp: u64, clock: u64) -> Result<bool, Refusal> {
        match self.seen.get_mut(&stream) {
            Some(seen) if timestamp <= seen.last => Err(Refusal::Replayed),
            Some(seen) => {
                seen.last = timestamp;
                seen.frames = seen.frames.saturating_add(1);
                let news = timestamp > seen.kept;
                if news {
                    seen.kept = timestamp.saturating_add(KEPT_AHEAD);
                }
                Ok(news)
            }
            None if is_late(timestamp, clock) || timestamp <= self.forgotten => Err(Refusal::Late),
            None => {
                self.make_room(clock);
                let kept = timestamp.saturating_add(KEPT_AHEAD);
                self.seen.insert(stream, Seen { last: timestamp, kept, frames: 1 });
                Ok(true)
            }
        }
    }

    fn make_room(&mut self, clock: u64) {
        if self.seen.len() < MOST_STREAMS {
            return;
        }
        let forgotten = &mut self.forgotten;
        self.seen.retain(|_, seen| {
            let stays = !is_late(seen.last, clock);
            if !stays {
                *forgotten = seen.last.max(*forgotten);
            }
            stays
        });
        while self.seen.len() >= MOST_STREAMS {
            let least = self.seen.iter().min_by_key(|(_, seen)| (seen.frames, seen.last));
            let Some((stream, last)) = least.map(|(stream, seen)| (*stream, seen.last)) else { return };
            self.seen.remove(&stream);
            self.forgotten = self.forgotten.max(last);
        }
    }

    /// The latest timestamp of all forgotten streams.
    pub fn forgotten(&self) -> u64 {
        self.forgotten
    }

    /// What the file must have while the program runs: timestamps that are ahead of those in use.
    pub fn kept(&self) -> BTreeMap<Stream, u64> {
        self.seen.iter().map(|(stream, seen)| (*stream, seen.kept)).collect()
    }

    /// The latest timestamps that were accepted.
    pub fn last(&self) -> BTreeMap<Stream, u64> {
        self.seen.iter().map(|(stream, seen)| (*stream, seen.last)).collect()
    }
}

fn is_late(timestamp: u64, clock: u64) -> bool {
    timestamp.saturating_add(NEW_STREAM_BEHIND) < clock
}
