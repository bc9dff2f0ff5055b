//! One direction between a vehicle and a client: it loses, delays and sometimes doubles.

use super::chance::Chance;

/// Longest delay of a message, µs: later ones may overtake it.
const LATE_US: f64 = 30_000.0;
/// Share of the messages that comes twice.
const TWICE: f64 = 0.005;

pub struct Channel<T> {
    waiting: Vec<(u64, T)>,
    loss: f64,
    pub sent: u64,
    pub lost: u64,
}

impl<T: Clone> Channel<T> {
    pub fn new(loss: f64) -> Self {
        Self { waiting: Vec::new(), loss, sent: 0, lost: 0 }
    }

    pub fn send(&mut self, item: T, now_us: u64, chance: &mut Chance) {
        self.sent += 1;
        if chance.share() < self.loss {
            self.lost += 1;
            return;
        }
        if chance.share() < TWICE {
            self.waiting.push((now_us + (chance.share() * LATE_US) as u64, item.clone()));
        }
        self.waiting.push((now_us + (chance.share() * LATE_US) as u64, item));
    }

    pub fn arrived(&mut self, now_us: u64) -> Vec<T> {
        let mut ready: Vec<(u64, T)> =
            self.waiting.extract_if(.., |(when_us, _)| *when_us <= now_us).collect();
        ready.sort_by_key(|(when_us, _)| *when_us);
        ready.into_iter().map(|(_, item)| item).collect()
    }
}
