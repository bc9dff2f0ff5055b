//! The latest events, for those who have missed one.

use std::collections::VecDeque;

use mavlink::dialects::ardupilotmega::EVENT_DATA;

/// So many are remembered.
const REMEMBERED: usize = 64;

/// The latest events with their numbers, which begin again after 65535.
#[derive(Clone, Debug, Default)]
pub struct EventBuffer {
    events: VecDeque<EVENT_DATA>,
    latest: u16,
}

impl EventBuffer {
    /// Takes an event in and gives it its number.
    pub fn push(&mut self, mut event: EVENT_DATA) -> EVENT_DATA {
        self.latest = self.latest.wrapping_add(1);
        event.sequence = self.latest;
        if self.events.len() >= REMEMBERED {
            self.events.pop_front();
        }
        self.events.push_back(event.clone());
        event
    }

    /// Number of the latest event; 0 before the first.
    pub fn latest(&self) -> u16 {
        self.latest
    }

    /// Whether there has been none yet.
    pub fn is_empty(&self) -> bool {
        self.events.is_empty()
    }

    /// The event of a number, if it is remembered.
    pub fn get(&self, sequence: u16) -> Option<&EVENT_DATA> {
        self.events.iter().find(|event| event.sequence == sequence)
    }

    /// Number of the oldest event that is remembered.
    pub fn oldest(&self) -> u16 {
        self.events.front().map_or(self.latest, |event| event.sequence)
    }
}
