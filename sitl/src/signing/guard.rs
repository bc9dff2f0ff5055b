//! Which frames are accepted, and what our own are signed with.

use std::collections::BTreeMap;

use autopilot::codec::{Frame, id};

use super::kept::{Kept, Stream};
use super::key::SecretKey;

/// A new stream may begin this far behind, units of 10 µs: a minute.
const NEW_STREAM_BEHIND: u64 = 6_000_000;
/// Timestamps are kept this far ahead of those in use, so that not every frame is a write: a second.
const KEPT_AHEAD: u64 = 100_000;
/// A timestamp beyond this leaves no room for later ones in its 48 bits: the last twelve hours of the year 2104.
const LAST: u64 = (1 << 48) - (1 << 32);
/// Streams that are remembered. One that is more than a minute behind may be forgotten: as a new one it is refused.
const MOST_STREAMS: usize = 1024;

/// Why a frame is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// It has no signature.
    #[error("unsigned")]
    Unsigned,
    /// Its signature is not made with the key.
    #[error("forged")]
    Forged,
    /// Its timestamp is not later than that of its stream: it has come before.
    #[error("replayed")]
    Replayed,
    /// Its stream is new and begins more than a minute ago.
    #[error("late")]
    Late,
    /// There is no room for its stream, or behind its timestamp.
    #[error("beyond capacity")]
    NoRoom,
}

/// How many frames were refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Counts {
    /// Without a signature.
    pub unsigned: u64,
    /// With a wrong one.
    pub forged: u64,
    /// Come again.
    pub replayed: u64,
    /// Of a new stream, too old.
    pub late: u64,
    /// Without room.
    pub no_room: u64,
}

impl Counts {
    fn count(&mut self, refusal: Refusal) {
        *match refusal {
            Refusal::Unsigned => &mut self.unsigned,
            Refusal::Forged => &mut self.forged,
            Refusal::Replayed => &mut self.replayed,
            Refusal::Late => &mut self.late,
            Refusal::NoRoom => &mut self.no_room,
        } += 1;
    }
}

impl std::fmt::Display for Counts {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let counts = [
            (self.unsigned, Refusal::Unsigned),
            (self.forged, Refusal::Forged),
            (self.replayed, Refusal::Replayed),
            (self.late, Refusal::Late),
            (self.no_room, Refusal::NoRoom),
        ];
        let told = counts.iter().filter(|(count, _)| *count > 0);
        let words: Vec<String> = told.map(|(count, refusal)| format!("{count} {refusal}")).collect();
        formatter.write_str(&words.join(", "))
    }
}

/// Timestamps of one stream.
#[derive(Clone, Copy, Debug)]
struct Seen {
    last: u64,
    /// As it is in the file.
    kept: u64,
}

/// Signs and verifies; without a key it lets everything pass.
#[derive(Clone, Debug, Default)]
pub struct Signing {
    key: Option<SecretKey>,
    /// The present, or the latest that was accepted if that is later.
    clock: u64,
    /// The latest that was accepted. Those of the streams lie ahead of it after a crash.
    heard: u64,
    sent: u64,
    sent_kept: u64,
    streams: BTreeMap<Stream, Seen>,
    counts: Counts,
    unkept: bool,
}

impl Signing {
    /// With what was kept of before.
    pub fn new(key: Option<SecretKey>, kept: Kept) -> Self {
        let seen = |last| Seen { last, kept: last };
        Self {
            key,
            clock: kept.heard,
            heard: kept.heard,
            sent: kept.sent,
            sent_kept: kept.sent,
            streams: kept.streams.into_iter().map(|(stream, last)| (stream, seen(last))).collect(),
            ..Self::default()
        }
    }

    /// Whether there is a key.
    pub fn is_on(&self) -> bool {
        self.key.is_some()
    }

    /// The key.
    pub fn key(&self) -> Option<&SecretKey> {
        self.key.as_ref()
    }

    /// Refused frames so far.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// The present: a timestamp of the wall clock.
    pub fn advance(&mut self, now: u64) {
        self.clock = self.clock.max(now.min(LAST));
    }

    /// Changes the key; `None` ends signing. Timestamps go on from where its sender says.
    pub fn set_key(&mut self, key: Option<SecretKey>, initial_timestamp: u64) {
        // Streams stay: the old key may be set again.
        self.key = key;
        self.clock = self.clock.max(initial_timestamp.min(LAST));
        self.unkept = true;
    }

    /// Whether a frame is accepted. Only one that is changes anything but the counts.
    ///
    /// # Errors
    /// [`Refusal`], which is counted.
    pub fn verify(&mut self, frame: &Frame) -> Result<(), Refusal> {
        let result = self.check(frame);
        if let Err(refusal) = result {
            self.counts.count(refusal);
        }
        result
    }

    fn check(&mut self, frame: &Frame) -> Result<(), Refusal> {
        let Some(key) = &self.key else { return Ok(()) };
        let Some(signature) = frame.signature() else {
            // A radio has no key.
            return if frame.message_id() == id::RADIO_STATUS { Ok(()) } else { Err(Refusal::Unsigned) };
        };
        if !key.made(&signature.tag, frame.covered_bytes()) {
            return Err(Refusal::Forged);
        }
        let (stream, timestamp) = ((signature.link, frame.system(), frame.component()), signature.timestamp);
        if timestamp > LAST {
            return Err(Refusal::NoRoom);
        }
        let known = self.streams.get(&stream).copied();
        match known {
            Some(seen) if timestamp <= seen.last => return Err(Refusal::Replayed),
            None if timestamp + NEW_STREAM_BEHIND < self.clock => return Err(Refusal::Late),
            None if !self.make_room() => return Err(Refusal::NoRoom),
            _ => {}
        }
        let kept = known.map_or(0, |seen| seen.kept);
        let kept = if timestamp > kept {
            self.unkept = true;
            timestamp + KEPT_AHEAD
        } else {
            kept
        };
        self.streams.insert(stream, Seen { last: timestamp, kept });
        self.clock = self.clock.max(timestamp);
        self.heard = self.heard.max(timestamp);
        Ok(())
    }

    fn make_room(&mut self) -> bool {
        if self.streams.len() >= MOST_STREAMS {
            let clock = self.clock;
            self.streams.retain(|_, seen| seen.last.saturating_add(NEW_STREAM_BEHIND) >= clock);
        }
        self.streams.len() < MOST_STREAMS
    }

    /// A frame of ours, signed if there is a key. No two have the same timestamp.
    pub fn sign(&mut self, frame: Frame, link: u8) -> Frame {
        let Some(key) = &self.key else { return frame };
        self.sent = self.clock.max(self.sent + 1);
        // Half of what is kept ahead is left for frames until it is kept again.
        if self.sent + KEPT_AHEAD / 2 > self.sent_kept {
            self.sent_kept = self.sent + KEPT_AHEAD;
            self.unkept = true;
        }
        frame.sign(link, self.sent, |bytes| key.tag(bytes))
    }

    /// Whether there is something to be kept.
    pub fn is_unkept(&self) -> bool {
        self.unkept
    }

    /// What is to be kept, if it has changed since the last call.
    pub fn take_unkept(&mut self) -> Option<Kept> {
        std::mem::take(&mut self.unkept).then(|| self.kept(self.sent_kept, |seen| seen.kept))
    }

    /// What was taken to be kept could not be: it is to be taken again.
    pub fn keep_again(&mut self) {
        self.unkept = true;
    }

    /// What is to be kept at an end that was asked for: no more than what was used.
    pub fn at_end(&self) -> Kept {
        self.kept(self.sent, |seen| seen.last)
    }

    fn kept(&self, sent: u64, of: impl Fn(&Seen) -> u64) -> Kept {
        let streams = self.streams.iter().map(|(stream, seen)| (*stream, of(seen))).collect();
        Kept { sent, heard: self.heard, streams }
    }
}
