//! Starting, pausing and continuing a mission, and its tick.

use super::super::notice::{Refusal, Severity};
use super::super::plans::check_mission_places;
use super::super::set_point::PositionSetPoint;
use super::super::speeds::SpeedChange;
use super::super::state::Vehicle;
use super::super::steering::SteeringKind;
use super::sequence::{navigates, next_from};
use super::task::TaskProgress;
use super::{Carry, Mission, Progress};
use crate::mode::Mode;
use crate::plan::command;

/// Items that are begun within one tick; more wait for the next.
const ITEMS_PER_TICK: usize = 16;

impl Vehicle {
    /// Starts the mission, or goes on with it; `first` names the item to begin with.
    ///
    /// # Errors
    /// [`Refusal`] without a mission, for one that the fence forbids, for an item that there is not, and when only landing is left.
    pub fn start_mission(&mut self, first: Option<usize>) -> Result<(), Refusal> {
        self.may_enter(Mode::Mission)?;
        self.situation().refuse_without_rotor()?;
        if !self.has_mission() {
            return Err(Refusal::later("Mission rejected: there is none"));
        }
        check_mission_places(&self.situation())
            .map_err(|fault| Refusal::denied(format!("Mission denied: {fault}")))?;
        if let Some(first) = first {
            self.set_mission_item(first, true)?;
        }
        self.machines.mission.paused = false;
        self.machines.failsafe.release();
        if self.decided.mode() != Mode::Mission {
            self.enter(Mode::Mission);
        } else if self.machines.mission.progress == Progress::Complete {
            self.begin_mission();
        } else if self.machines.mission.task.is_none() {
            self.take_over();
        }
        Ok(())
    }

    /// Whether there is something to be flown.
    pub fn has_mission(&self) -> bool {
        self.mission_items().iter().skip(self.first_mission_item()).any(navigates)
    }

    /// Pauses: PX4 holds in its own mode for that, ArduPilot within the mission's.
    ///
    /// # Errors
    /// [`Refusal`] when it cannot hold now.
    pub fn pause(&mut self) -> Result<(), Refusal> {
        if self.decided.mode() != Mode::Mission || !self.setup.identity().is_ardupilot() {
            return self.set_mode(Mode::Hold);
        }
        self.machines.mission.paused = true;
        self.suspend();
        self.consult(|_, situation, proposal| proposal.hold(situation));
        self.decided.say(Severity::Info, "Mission paused");
        Ok(())
    }

    /// Goes on with the item at which the mission was left.
    ///
    /// # Errors
    /// [`Refusal`] when nothing was paused.
    pub fn continue_mission(&mut self) -> Result<(), Refusal> {
        if self.machines.mission.progress != Progress::Started || !self.has_mission() {
            return Err(Refusal::denied("Nothing to continue"));
        }
        self.start_mission(None)
    }

    /// Makes an item the current one; with `reset` the jumps count anew.
    ///
    /// # Errors
    /// [`Refusal`] for an item that there is not.
    pub fn set_mission_item(&mut self, index: usize, reset: bool) -> Result<(), Refusal> {
        let count = self.mission_items().len();
        if index >= count {
            return Err(Refusal::denied(format!("Mission has no item {index} among {count}")));
        }
        if reset {
            self.machines.mission.jumps.clear();
        }
        if self.machines.mission.progress == Progress::Complete {
            self.machines.mission.progress = Progress::NotStarted;
        }
        self.suspend();
        self.drop_conditions();
        self.machines.mission.current = index.max(self.first_mission_item());
        if self.decided.mode() == Mode::Mission && !self.machines.mission.paused {
            self.take_over();
        }
        Ok(())
    }

    /// A new mission begins at its first item, a changed one goes on where it was.
    pub(in super::super) fn mission_has_changed(&mut self, amended: bool) {
        if !amended {
            let reached = std::mem::take(&mut self.machines.mission.reached);
            self.consult(|_, _, proposal| proposal.change_speeds(SpeedChange::ForgetMission));
            self.decided.look_at(None);
            self.machines.mission =
                Mission { reached, current: self.first_mission_item(), ..Mission::default() };
        }
        self.suspend();
        self.drop_conditions();
        if self.decided.mode() != Mode::Mission {
            return;
        }
        if self.has_mission() {
            self.take_over();
        } else {
            self.decided.say(Severity::Warning, "Mission cleared: holding");
            self.enter(Mode::Hold);
        }
    }

    /// The mode is entered.
    pub(in super::super) fn enter_mission(&mut self) {
        match self.machines.mission.progress {
            Progress::NotStarted | Progress::Started => self.take_over(),
            Progress::Complete => self.begin_mission(),
        }
    }

    /// The mode is left.
    pub(in super::super) fn leave_mission(&mut self) {
        self.machines.mission.paused = false;
        self.suspend();
        self.consult(|_, _, proposal| proposal.change_speeds(SpeedChange::InMission(false)));
    }

    /// Gives up what is being done for the current item, to be begun again.
    fn suspend(&mut self) {
        self.machines.mission.task = None;
        self.machines.mission.carry = None;
    }

    fn begin_mission(&mut self) {
        self.suspend();
        self.drop_conditions();
        self.machines.mission.jumps.clear();
        self.decided.look_at(None);
        self.consult(|_, _, proposal| proposal.change_speeds(SpeedChange::ForgetMission));
        self.machines.mission.progress = Progress::NotStarted;
        self.machines.mission.current = self.first_mission_item();
        self.take_over();
    }

    /// Goes on from where the vehicle is.
    fn take_over(&mut self) {
        self.machines.mission.carry = None;
        self.machines.mission.anchor_m =
            self.decided.steering().present(self.perception.outputs()).position_m;
        self.machines.mission.heading_rad = self.perception.outputs().attitude_rad.z;
        self.consult(|_, _, proposal| proposal.change_speeds(SpeedChange::InMission(true)));
        self.consult(|_, situation, proposal| proposal.hold(situation));
    }

    /// One tick of the mission.
    pub(in super::super) fn fly_mission(&mut self) {
        if self.machines.mission.paused || self.machines.mission.progress == Progress::Complete {
            self.consult(|_, situation, proposal| proposal.turn_to_region(situation));
            return;
        }
        // An attitude that was left behind, or a stick: the mission flies by position.
        if self.decided.steering().kind() == SteeringKind::Attitude {
            self.consult(|_, situation, proposal| proposal.follow(situation, &PositionSetPoint::HOLD));
        }
        self.machines.mission.progress = Progress::Started;
        for _ in 0..ITEMS_PER_TICK {
            let Some(item) = self.mission_items().get(self.machines.mission.current).copied() else {
                self.complete_mission();
                return;
            };
            if !navigates(&item) {
                self.go_on_from(self.machines.mission.current);
                continue;
            }
            let progress = match self.machines.mission.task {
                None => self.begin_item(&item),
                Some(task) => self.carry_on(task, &item),
            };
            match progress {
                TaskProgress::Going => break,
                TaskProgress::Again => self.machines.mission.task = None,
                TaskProgress::Done(carry) => {
                    self.item_is_done(carry);
                    if self.decided.mode() != Mode::Mission
                        || self.machines.mission.progress == Progress::Complete
                    {
                        return;
                    }
                    if self.machines.mission.paused {
                        return;
                    }
                }
            }
        }
        self.act();
        if self.decided.mode() == Mode::Mission {
            self.turn_on_the_way();
        }
    }

    fn item_is_done(&mut self, carry: Option<Carry>) {
        let index = self.machines.mission.current;
        let Some(item) = self.mission_items().get(index).copied() else { return };
        self.suspend();
        self.drop_conditions();
        self.machines.mission.carry = carry;
        self.reached_item(index);
        if item.command == command::NAV_RETURN_TO_LAUNCH {
            self.complete_mission();
            if self.decided.steering().kind() != SteeringKind::Idle {
                self.enter(Mode::Return);
            }
            return;
        }
        if self.continues_after(&item) {
            self.go_on_from(index + 1);
        } else {
            self.machines.mission.current = index + 1;
            self.decided.say(Severity::Info, format!("Mission waits after item {index}"));
            self.enter(Mode::Hold);
        }
    }

    /// Looks for the next item that navigates; what lies before it is done on the way.
    fn go_on_from(&mut self, index: usize) {
        let mut made = std::mem::take(&mut self.machines.mission.jumps);
        let next = next_from(self.mission_items(), index, &mut made);
        self.machines.mission.jumps = made;
        for jump in next.jumps {
            self.reached_item(jump);
        }
        self.machines.mission.actions = next.actions.into();
        match next.navigation {
            Some(index) => self.machines.mission.current = index,
            None => {
                self.act();
                self.complete_mission();
            }
        }
    }

    fn complete_mission(&mut self) {
        self.suspend();
        self.drop_conditions();
        self.machines.mission.progress = Progress::Complete;
        self.machines.mission.current = self.mission_items().len().saturating_sub(1);
        self.decided.say(Severity::Info, "Mission complete");
        // On the ground the vehicle disarms in its mode, as after any landing.
        if !self.setup.identity().is_ardupilot() && self.decided.steering().kind() != SteeringKind::Idle {
            self.enter(Mode::Hold);
        }
    }

    pub(super) fn reached_item(&mut self, index: usize) {
        self.machines.mission.reached.push(u16::try_from(index).unwrap_or(u16::MAX));
    }
}
