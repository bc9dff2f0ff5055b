//! A gripper.

/// Time that it moves for, µs.
const MOVES_US: u64 = 1_000_000;

/// What the gripper does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Gripper {
    grabs: bool,
    /// When it was told so, µs; `None`: nobody has told it anything yet.
    since_us: Option<u64>,
    moves: bool,
}

/// What it has begun or done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grip {
    /// It begins to grab.
    Grabbing,
    /// It begins to release.
    Releasing,
    /// It has grabbed.
    Grabbed,
    /// It has released.
    Released,
}

impl Grip {
    /// As clients are told.
    pub fn word(self) -> &'static str {
        match self {
            Self::Grabbing => "grabbing",
            Self::Releasing => "releasing",
            Self::Grabbed => "grabbed",
            Self::Released => "released",
        }
    }
}

impl Gripper {
    /// Whether it holds, or is about to.
    pub fn grabs(&self) -> bool {
        self.grabs
    }

    /// Whether nobody has told it anything yet.
    pub fn waits(&self) -> bool {
        self.since_us.is_none()
    }

    /// Whether it moves, or will by itself: open, it closes after a time, s, unless that is 0.
    pub fn acts(&self, closes_after_s: f64) -> bool {
        self.moves || self.closes_by_itself(closes_after_s)
    }

    /// Grabs, or releases.
    pub fn command(&mut self, grabs: bool, now_us: u64) {
        *self = Self { grabs, since_us: Some(now_us), moves: true };
    }

    /// What has happened by now.
    pub fn step(&mut self, now_us: u64, closes_after_s: f64) -> Option<Grip> {
        let passed_us = now_us.saturating_sub(self.since_us?);
        if self.moves {
            self.moves = passed_us < MOVES_US;
            return (!self.moves).then_some(if self.grabs { Grip::Grabbed } else { Grip::Released });
        }
        let closes = self.closes_by_itself(closes_after_s) && passed_us as f64 > 1e6 * closes_after_s;
        closes.then(|| {
            self.command(true, now_us);
            Grip::Grabbing
        })
    }

    fn closes_by_itself(&self, closes_after_s: f64) -> bool {
        !self.grabs && !self.waits() && closes_after_s > 0.0
    }
}
