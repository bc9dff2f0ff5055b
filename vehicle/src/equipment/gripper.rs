//! A gripper.

/// Time that it moves for, µs.
const MOVES_US: u64 = 1_000_000;

/// What the gripper does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Gripper {
    grabs: bool,
    /// When it has come to its end, µs.
    until_us: Option<u64>,
}

impl Gripper {
    /// Whether it holds, or is about to.
    pub fn grabs(&self) -> bool {
        self.grabs
    }

    /// Whether it moves.
    pub fn moves(&self) -> bool {
        self.until_us.is_some()
    }

    /// Grabs, or releases.
    pub fn command(&mut self, grabs: bool, now_us: u64) {
        *self = Self { grabs, until_us: Some(now_us + MOVES_US) };
    }

    /// What has ended by now: whether it has grabbed.
    pub fn step(&mut self, now_us: u64) -> Option<bool> {
        let ended = self.until_us.is_some_and(|until_us| now_us >= until_us);
        if ended {
            self.until_us = None;
        }
        ended.then_some(self.grabs)
    }
}
