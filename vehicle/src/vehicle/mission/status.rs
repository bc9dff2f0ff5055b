//! How far a mission has come, for whoever watches it.

use nalgebra::Vector3;

use super::super::state::Vehicle;
use super::task::Task;
use super::{Mission, Progress};
use crate::mode::Mode;
use crate::plan::Program;

/// MISSION_STATE.
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
    /// What is flown.
    pub(in super::super) fn program(&self) -> &Program {
        &self.program
    }
}

impl Vehicle {
    /// Where the mission is.
    pub fn mission_status(&self) -> MissionStatus {
        let mission = &self.mission;
        let in_mode = self.mode == Mode::Mission;
        let state = match mission.progress {
            _ if mission.program.is_empty() => MissionState::None,
            Progress::Complete => MissionState::Complete,
            Progress::NotStarted => MissionState::NotStarted,
            Progress::Started if in_mode && !mission.paused => MissionState::Active,
            Progress::Started => MissionState::Paused,
        };
        let total = mission.program.len().saturating_sub(mission.program.first());
        MissionStatus { current: mission.current, total, state, in_mode }
    }

    /// Items that were reached since the last call.
    pub fn take_reached_items(&mut self) -> Vec<u16> {
        std::mem::take(&mut self.mission.reached)
    }

    /// The end of the present leg, NED, m, and the vehicle's distance from the leg's line, positive to the right, m.
    pub fn leg_errors(&self) -> Option<(Vector3<f64>, f64)> {
        match &self.mission.task {
            Some(Task::Leg(leg, _)) => Some((leg.to_m, leg.cross_track_m(&self.outputs.position_m))),
            _ => None,
        }
    }
}
