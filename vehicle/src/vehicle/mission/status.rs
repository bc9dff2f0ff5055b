//! What clients are told of a mission.

use super::machine::{Mission, Progress};
use crate::mode::Mode;

/// How far a mission has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MissionState {
    /// There is none.
    None,
    /// It waits for its start.
    NotStarted,
    /// It is flown.
    Active,
    /// It was left, and can go on.
    Paused,
    /// Its last item is done.
    Complete,
}

/// Where a mission is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MissionStatus {
    /// The item that is flown, or will be.
    pub current: usize,
    /// Number of items; in ArduPilot's convention without home.
    pub total: usize,
    /// How far it is.
    pub state: MissionState,
    /// Whether the vehicle is in the mode that flies it.
    pub in_mode: bool,
}

impl Mission {
    /// Where it is, seen from a mode.
    pub fn status(&self, mode: Mode) -> MissionStatus {
        let program = self.program();
        let in_mode = mode == Mode::Mission;
        let state = match self.progress() {
            _ if program.is_empty() => MissionState::None,
            Progress::Complete => MissionState::Complete,
            Progress::NotStarted => MissionState::NotStarted,
            Progress::Started if in_mode && !self.is_paused() => MissionState::Active,
            Progress::Started => MissionState::Paused,
        };
        let total = program.len().saturating_sub(program.first());
        // Before its first step is flown or chosen it is nowhere.
        let waits = state == MissionState::NotStarted && !self.is_chosen();
        let current = if waits { 0 } else { self.current() };
        MissionStatus { current, total, state, in_mode }
    }
}
