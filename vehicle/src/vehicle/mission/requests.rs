//! The mission of a vehicle: what clients ask of it and what happens to it, passed on to the machine.

use nalgebra::Vector3;

use super::super::notice::Refusal;
use super::super::state::Vehicle;
use super::status::MissionStatus;
use crate::mode::Mode;

impl Vehicle {
    /// Starts the mission, or goes on with it; `first` names the item to begin with.
    ///
    /// # Errors
    /// [`Refusal`] without a mission, for one that the fence forbids, for an item that there is not, and when only landing is left.
    pub fn start_mission(&mut self, first: Option<usize>) -> Result<(), Refusal> {
        self.may_enter(Mode::Mission)?;
        self.situation().refuse_without_rotor()?;
        self.consult(|parts, situation, proposal| {
            parts.mission.start(situation, proposal, first)?;
            parts.failsafe.release();
            Ok(())
        })
    }

    /// Whether there is something to be flown.
    pub fn has_mission(&self) -> bool {
        self.machines.mission.program().is_flown()
    }

    /// Pauses: PX4 holds in its own mode for that, ArduPilot within the mission's.
    ///
    /// # Errors
    /// [`Refusal`] when it cannot hold now.
    pub fn pause(&mut self) -> Result<(), Refusal> {
        if self.mode() != Mode::Mission || !self.identity().is_ardupilot() {
            return self.set_mode(Mode::Hold);
        }
        self.consult(|parts, situation, proposal| parts.mission.pause(situation, proposal));
        Ok(())
    }

    /// Goes on with the item at which the mission was left.
    ///
    /// # Errors
    /// [`Refusal`] when nothing was paused.
    pub fn continue_mission(&mut self) -> Result<(), Refusal> {
        self.machines.mission.may_continue()?;
        self.start_mission(None)
    }

    /// Makes an item the current one; with `reset` the jumps count anew.
    ///
    /// # Errors
    /// [`Refusal`] for an item that there is not.
    pub fn set_mission_item(&mut self, index: usize, reset: bool) -> Result<(), Refusal> {
        self.consult(|parts, situation, proposal| {
            parts.mission.set_current(situation, proposal, index, reset)
        })
    }

    /// Where the mission is.
    pub fn mission_status(&self) -> MissionStatus {
        self.machines.mission.status(self.mode())
    }

    /// Items that were reached since the last call.
    pub fn take_reached_items(&mut self) -> Vec<u16> {
        self.machines.mission.take_reached()
    }

    /// The end of the present leg, NED, m, and the vehicle's distance from the leg's line, positive to the right, m.
    pub fn leg_errors(&self) -> Option<(Vector3<f64>, f64)> {
        let leg = self.machines.mission.leg()?;
        Some((leg.to_m, leg.cross_track_m(&self.outputs().position_m)))
    }
}
