//! Starting, pausing and continuing a mission, and its tick.

use super::super::notice::{Refusal, Severity};
use super::super::set_point::PositionSetPoint;
use super::super::state::Vehicle;
use super::super::steering::SteeringKind;
use super::sequence::next_from;
use super::task::TaskProgress;
use super::{Carry, Mission, Progress};
use crate::mode::Mode;
use crate::plan::Program;
use crate::plan::step::{Navigate, Step};

/// Items that are begun within one tick; more wait for the next.
const ITEMS_PER_TICK: usize = 16;

impl Vehicle {
    /// Starts the mission, or goes on with it; `first` names the item to begin with.
    ///
    /// # Errors
    /// [`Refusal`] without a mission, for one that the fence forbids, for an item that there is not, and when only landing is left.
    pub fn start_mission(&mut self, first: Option<usize>) -> Result<(), Refusal> {
        self.may_enter(Mode::Mission)?;
        self.refuse_without_rotor()?;
        if !self.has_mission() {
            return Err(Refusal::later("Mission rejected: there is none"));
        }
        self.check_mission_places().map_err(|fault| Refusal::denied(format!("Mission denied: {fault}")))?;
        if let Some(first) = first {
            self.set_mission_item(first, true)?;
        }
        self.mission.paused = false;
        self.failsafe.release();
        if self.mode != Mode::Mission {
            self.enter(Mode::Mission);
        } else if self.mission.progress == Progress::Complete {
            self.begin_mission();
        } else if self.mission.task.is_none() {
            self.take_over();
        }
        Ok(())
    }

    /// Whether there is something to be flown.
    pub fn has_mission(&self) -> bool {
        self.mission.program.is_flown()
    }

    /// Pauses: PX4 holds in its own mode for that, ArduPilot within the mission's.
    ///
    /// # Errors
    /// [`Refusal`] when it cannot hold now.
    pub fn pause(&mut self) -> Result<(), Refusal> {
        if self.mode != Mode::Mission || !self.identity.is_ardupilot() {
            return self.set_mode(Mode::Hold);
        }
        self.mission.paused = true;
        self.suspend();
        self.hold();
        self.say(Severity::Info, "Mission paused");
        Ok(())
    }

    /// Goes on with the item at which the mission was left.
    ///
    /// # Errors
    /// [`Refusal`] when nothing was paused.
    pub fn continue_mission(&mut self) -> Result<(), Refusal> {
        if self.mission.progress != Progress::Started || !self.has_mission() {
            return Err(Refusal::denied("Nothing to continue"));
        }
        self.start_mission(None)
    }

    /// Makes an item the current one; with `reset` the jumps count anew.
    ///
    /// # Errors
    /// [`Refusal`] for an item that there is not.
    pub fn set_mission_item(&mut self, index: usize, reset: bool) -> Result<(), Refusal> {
        let count = self.mission.program.len();
        if index >= count {
            return Err(Refusal::denied(format!("Mission has no item {index} among {count}")));
        }
        if reset {
            self.mission.jumps.clear();
        }
        if self.mission.progress == Progress::Complete {
            self.mission.progress = Progress::NotStarted;
        }
        self.suspend();
        self.drop_conditions();
        self.mission.current = index.max(self.mission.program.first());
        if self.mode == Mode::Mission && !self.mission.paused {
            self.take_over();
        }
        Ok(())
    }

    /// A new mission begins at its first item, a changed one goes on where it was.
    pub(in super::super) fn mission_has_changed(&mut self, program: Program, amended: bool) {
        if amended {
            self.mission.program = program;
        } else {
            let reached = std::mem::take(&mut self.mission.reached);
            self.forget_mission_speeds();
            self.region = None;
            self.mission = Mission { reached, current: program.first(), program, ..Mission::default() };
        }
        self.suspend();
        self.drop_conditions();
        if self.mode != Mode::Mission {
            return;
        }
        if self.has_mission() {
            self.take_over();
        } else {
            self.say(Severity::Warning, "Mission cleared: holding");
            self.enter(Mode::Hold);
        }
    }

    /// The mode is entered.
    pub(in super::super) fn enter_mission(&mut self) {
        match self.mission.progress {
            Progress::NotStarted | Progress::Started => self.take_over(),
            Progress::Complete => self.begin_mission(),
        }
    }

    /// The mode is left.
    pub(in super::super) fn leave_mission(&mut self) {
        self.mission.paused = false;
        self.suspend();
        self.apply_mission_speeds(false);
    }

    /// Gives up what is being done for the current item, to be begun again.
    fn suspend(&mut self) {
        self.mission.task = None;
        self.mission.carry = None;
    }

    fn begin_mission(&mut self) {
        self.suspend();
        self.drop_conditions();
        self.mission.jumps.clear();
        self.region = None;
        self.forget_mission_speeds();
        self.mission.progress = Progress::NotStarted;
        self.mission.current = self.mission.program.first();
        self.take_over();
    }

    /// Goes on from where the vehicle is.
    fn take_over(&mut self) {
        self.mission.carry = None;
        self.mission.anchor_m = self.steering.present(&self.outputs).position_m;
        self.mission.heading_rad = self.outputs.attitude_rad.z;
        self.apply_mission_speeds(true);
        self.hold();
    }

    /// One tick of the mission.
    pub(in super::super) fn fly_mission(&mut self) {
        if self.mission.paused || self.mission.progress == Progress::Complete {
            self.turn_to_region();
            return;
        }
        // An attitude that was left behind, or a stick: the mission flies by position.
        if self.steering.kind() == SteeringKind::Attitude {
            self.follow(&PositionSetPoint::HOLD);
        }
        self.mission.progress = Progress::Started;
        for _ in 0..ITEMS_PER_TICK {
            let Some(step) = self.mission.program.step(self.mission.current) else {
                self.complete_mission();
                return;
            };
            let Step::Navigate(step) = step else {
                self.go_on_from(self.mission.current);
                continue;
            };
            let progress = match self.mission.task {
                None => self.begin_step(&step),
                Some(task) => self.carry_on(task, &step),
            };
            match progress {
                TaskProgress::Going => break,
                TaskProgress::Again => self.mission.task = None,
                TaskProgress::Done(carry) => {
                    self.item_is_done(carry);
                    if self.mode != Mode::Mission || self.mission.progress == Progress::Complete {
                        return;
                    }
                    if self.mission.paused {
                        return;
                    }
                }
            }
        }
        self.act();
        if self.mode == Mode::Mission {
            self.turn_on_the_way();
        }
    }

    fn item_is_done(&mut self, carry: Option<Carry>) {
        let index = self.mission.current;
        let Some(step) = self.mission.program.step(index) else { return };
        self.suspend();
        self.drop_conditions();
        self.mission.carry = carry;
        self.reached_item(index);
        if step == Step::Navigate(Navigate::ReturnToLaunch) {
            self.complete_mission();
            if self.steering.kind() != SteeringKind::Idle {
                self.enter(Mode::Return);
            }
            return;
        }
        if self.mission.program.continues_after(index) {
            self.go_on_from(index + 1);
        } else {
            self.mission.current = index + 1;
            self.say(Severity::Info, format!("Mission waits after item {index}"));
            self.enter(Mode::Hold);
        }
    }

    /// Looks for the next item that navigates; what lies before it is done on the way.
    fn go_on_from(&mut self, index: usize) {
        let mut made = std::mem::take(&mut self.mission.jumps);
        let next = next_from(&self.mission.program, index, &mut made);
        self.mission.jumps = made;
        for jump in next.jumps {
            self.reached_item(jump);
        }
        self.mission.actions = next.actions.into();
        match next.navigation {
            Some(index) => self.mission.current = index,
            None => {
                self.act();
                self.complete_mission();
            }
        }
    }

    fn complete_mission(&mut self) {
        self.suspend();
        self.drop_conditions();
        self.mission.progress = Progress::Complete;
        self.mission.current = self.mission.program.len().saturating_sub(1);
        self.say(Severity::Info, "Mission complete");
        // On the ground the vehicle disarms in its mode, as after any landing.
        if !self.identity.is_ardupilot() && self.steering.kind() != SteeringKind::Idle {
            self.enter(Mode::Hold);
        }
    }

    pub(super) fn reached_item(&mut self, index: usize) {
        self.mission.reached.push(u16::try_from(index).unwrap_or(u16::MAX));
    }

    /// Whether the mission goes on by itself on the ground.
    pub(in super::super) fn mission_goes_on(&self) -> bool {
        self.mode == Mode::Mission && self.mission.progress == Progress::Started && self.flown && self.armed
    }
}
