//! How much may be sent to a peer whose address somebody else may have written.

use std::time::{Duration, Instant};

/// A peer that has not been heard for this long is not talking any more.
pub(super) const SILENCE: Duration = Duration::from_secs(5);
/// A peer that has been talking for this long gets everything.
pub(super) const TALK: Duration = Duration::from_secs(2);
/// Bytes that a peer may draw before that, for each byte received from it.
pub(super) const FACTOR: usize = 10;

/// What a peer may be sent.
///
/// Anybody can send a datagram in the name of another address, which then gets the answers. Therefore an address beyond this machine
/// draws at most ten times the bytes that came from it, and only heartbeats and answers, unless it keeps talking: for two seconds,
/// and at least every five. Frames that are signed with the key lift the limit at once.
#[derive(Clone, Debug)]
pub struct Allowance {
    limited: bool,
    open: bool,
    /// First and latest frame since it began to talk.
    talk: Option<(Instant, Instant)>,
    credit: usize,
}

impl Allowance {
    /// Of a peer, limited if its address may be somebody else's.
    pub fn new(limited: bool) -> Self {
        Self { limited, open: !limited, talk: None, credit: 0 }
    }

    /// Takes in an accepted frame.
    pub fn hear(&mut self, length: usize, signed: bool, now: Instant) {
        self.limited &= !signed;
        let begin = self.talk.filter(|(_, last)| !is_over(*last, now)).map_or(now, |(begin, _)| begin);
        self.talk = Some((begin, now));
        self.credit = self.credit.saturating_add(FACTOR * length);
        self.update(now);
    }

    /// Takes in the time.
    pub fn update(&mut self, now: Instant) {
        let talks =
            self.talk.is_some_and(|(begin, last)| last.duration_since(begin) >= TALK && !is_over(last, now));
        if self.open && !talks {
            // What it has not drawn while it talked it does not draw later.
            self.credit = 0;
        }
        self.open = !self.limited || talks;
    }

    /// Whether it gets everything.
    pub fn is_open(&self) -> bool {
        self.open
    }

    /// Whether a frame of some bytes may be sent to it, which is then counted; `essential`: a heartbeat or an answer.
    pub fn spend(&mut self, length: usize, essential: bool) -> bool {
        if self.open {
            return true;
        }
        let allowed = essential && length <= self.credit;
        if allowed {
            self.credit -= length;
        }
        allowed
    }
}

impl Default for Allowance {
    fn default() -> Self {
        Self::new(false)
    }
}

fn is_over(last: Instant, now: Instant) -> bool {
    now.saturating_duration_since(last) >= SILENCE
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use super::Allowance;

    /// Bytes drawn by as many essential frames as it allows, at most a thousand.
    fn drawn(allowance: &mut Allowance) -> usize {
        (0..1000).filter(|_| allowance.spend(21, true)).count() * 21
    }

    #[test]
    fn one_frame_draws_ten_times_its_length_and_no_telemetry() {
        let mut allowance = Allowance::new(true);
        assert_eq!(drawn(&mut allowance), 0);
        allowance.hear(21, false, Instant::now());
        assert!(!allowance.is_open() && !allowance.spend(1, false));
        assert_eq!(drawn(&mut allowance), 210);
    }

    #[test]
    fn who_keeps_talking_gets_everything_until_it_stops() {
        let start = Instant::now();
        let after = |ms| start + Duration::from_millis(ms);
        let mut allowance = Allowance::new(true);
        for second in 0..=2 {
            assert!(!allowance.is_open());
            allowance.hear(21, false, after(1000 * second));
        }
        assert!(allowance.is_open() && allowance.spend(1 << 20, false));
        allowance.update(after(6_999));
        assert!(allowance.is_open());
        allowance.update(after(7_000));
        assert!(!allowance.is_open());
        assert_eq!(drawn(&mut allowance), 0);
        // A frame now and then is no talk.
        for minute in 1..5 {
            allowance.hear(21, false, after(60_000 * minute));
            assert!(!allowance.is_open());
            assert_eq!(drawn(&mut allowance), 210);
        }
    }

    #[test]
    fn nobody_signs_in_the_name_of_another_and_loopback_has_no_limit() {
        let mut allowance = Allowance::new(true);
        allowance.hear(34, true, Instant::now());
        allowance.update(Instant::now() + Duration::from_secs(50));
        assert!(allowance.is_open());
        assert!(Allowance::default().is_open() && Allowance::default().spend(1 << 20, false));
    }
}
