//! What the vehicle has been given: conventions, behaviour, place and time.

use super::conduct::Conduct;
use crate::identity::Identity;
use crate::world::LocalFrame;

/// What only a user changes.
#[derive(Clone, Debug)]
pub struct Setup {
    identity: Identity,
    conduct: Conduct,
    frame: LocalFrame,
    unix_start_us: u64,
}

impl Setup {
    /// Starts at an unknown time of day.
    pub fn new(identity: Identity, conduct: Conduct, frame: LocalFrame) -> Self {
        Self { identity, conduct, frame, unix_start_us: 0 }
    }

    /// Whose conventions it follows.
    pub fn identity(&self) -> Identity {
        self.identity
    }

    /// Parameters of its behaviour.
    pub fn conduct(&self) -> &Conduct {
        &self.conduct
    }

    /// Changes the parameters of its behaviour.
    pub fn set_conduct(&mut self, conduct: Conduct) {
        self.conduct = conduct;
    }

    /// The local frame.
    pub fn frame(&self) -> &LocalFrame {
        &self.frame
    }

    /// Time of the start since 1970, µs.
    pub fn unix_start_us(&self) -> u64 {
        self.unix_start_us
    }

    /// Tells what time it was at the start, µs since 1970.
    pub fn set_unix_start_us(&mut self, unix_start_us: u64) {
        self.unix_start_us = unix_start_us;
    }
}
