//! Which frames are accepted, and what our own are signed with.

use autopilot::codec::{Frame, id};

use super::kept::Kept;
use super::key::SecretKey;
use super::streams::{KEPT_AHEAD, Streams};

/// A timestamp may be this far ahead of the clock, units of 10 µs: a minute.
pub const MOST_AHEAD: u64 = 6_000_000;

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
    /// Its timestamp is more than a minute ahead of the clock.
    #[error("early")]
    Early,
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
    /// Ahead of the clock.
    pub early: u64,
}

impl Counts {
    fn count(&mut self, refusal: Refusal) {
        *match refusal {
            Refusal::Unsigned => &mut self.unsigned,
            Refusal::Forged => &mut self.forged,
            Refusal::Replayed => &mut self.replayed,
            Refusal::Late => &mut self.late,
            Refusal::Early => &mut self.early,
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
            (self.early, Refusal::Early),
        ];
        let told = counts.iter().filter(|(count, _)| *count > 0);
        let words: Vec<String> = told.map(|(count, refusal)| format!("{count} {refusal}")).collect();
        formatter.write_str(&words.join(", "))
    }
}

/// Signs and verifies; without a key it lets everything pass.
///
/// The clock is the machine's. Timestamps that are received do not move it, or a client whose clock is ahead could lock out all
/// others: it is refused instead.
#[derive(Clone, Debug, Default)]
pub struct Signing {
    key: Option<SecretKey>,
    clock: u64,
    sent: u64,
    sent_kept: u64,
    streams: Streams,
    counts: Counts,
    unkept: bool,
}

impl Signing {
    /// With what was kept of before.
    pub fn new(key: Option<SecretKey>, kept: Kept) -> Self {
        Self {
            key,
            sent: kept.sent,
            sent_kept: kept.sent,
            streams: Streams::new(kept.streams, kept.forgotten),
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

    /// Sets the clock: the timestamp of the present.
    pub fn set_clock(&mut self, now: u64) {
        self.clock = now;
    }

    /// Changes the key; `None` ends signing.
    pub fn set_key(&mut self, key: Option<SecretKey>) {
        // Streams stay: the old key may be set again.
        self.key = key;
        self.unkept = true;
    }

    /// Signs with timestamps from this one on, so that a client whose clock is a little ahead does not find them too old.
    /// Returns whether that is possible: not with one more than a minute ahead.
    pub fn start_from(&mut self, initial_timestamp: u64) -> bool {
        let possible = initial_timestamp <= self.sent.max(self.clock.saturating_add(MOST_AHEAD));
        if possible {
            self.sent = self.sent.max(initial_timestamp);
            self.unkept = true;
        }
        possible
    }

    /// The latest timestamp that is accepted. Clients follow timestamps of ours that are ahead of the clock, because it has gone back.
    fn latest(&self) -> u64 {
        self.clock.max(self.sent).saturating_add(MOST_AHEAD)
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
        if signature.timestamp > self.latest() {
            return Err(Refusal::Early);
        }
        let stream = (signature.link, frame.system(), frame.component());
        self.unkept |= self.streams.accept(stream, signature.timestamp, self.clock)?;
        Ok(())
    }

    /// A frame of ours, signed if there is a key. No two have the same timestamp.
    pub fn sign(&mut self, frame: Frame, link: u8) -> Frame {
        let Some(key) = &self.key else { return frame };
        self.sent = self.clock.max(self.sent.saturating_add(1));
        // Half of what is kept ahead is left for frames until it is kept again.
        if self.sent.saturating_add(KEPT_AHEAD / 2) > self.sent_kept {
            self.sent_kept = self.sent.saturating_add(KEPT_AHEAD);
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
        std::mem::take(&mut self.unkept).then(|| Kept {
            sent: self.sent_kept,
            forgotten: self.streams.forgotten(),
            streams: self.streams.kept(),
        })
    }

    /// What was taken to be kept could not be: it is to be taken again.
    pub fn keep_again(&mut self) {
        self.unkept = true;
    }

    /// What is to be kept at an end that was asked for: no more than what was used.
    pub fn at_end(&self) -> Kept {
        Kept { sent: self.sent, forgotten: self.streams.forgotten(), streams: self.streams.last() }
    }
}
