//! The mission as a machine: which step is flown, and what becomes of it.

mod takeoffs;

use nalgebra::Vector3;

use super::super::heading_policy::{HeadingPolicy, Purpose};
use super::super::notice::{Refusal, Severity};
use super::super::plans::{check_reach, check_way};
use super::super::proposal::Proposal;
use super::super::set_point::PositionSetPoint;
use super::super::situation::Situation;
use super::super::speeds::SpeedChange;
use super::super::steering::{Steering, SteeringKind};
use super::actions::Actions;
use super::announcement;
use super::course::Course;
use super::jumps::Jumps;
use super::leg::Turn;
use super::leg_end::leg_end_m;
use super::route::Route;
use super::task::{Helm, TaskProgress};
use crate::mode::Mode;
use crate::plan::Program;
use crate::plan::step::{Navigate, Step, Turn as StepTurn};

/// Steps that are begun within one tick; more wait for the next.
const STEPS_PER_TICK: usize = 16;

/// A mission, and how far it has come.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Mission {
    program: Program,
    progress: Progress,
    /// Number of the step that is flown, or will be.
    current: usize,
    jumps: Jumps,
    /// What is done for it.
    course: Course,
    /// What is done on the way to it.
    actions: Actions,
    /// Whether it waits in its own mode.
    paused: bool,
    /// Whether it flies its landing in place of a way home.
    lands: bool,
    /// Whether somebody has chosen the present step.
    chosen: bool,
    /// The step that was told last.
    told: Option<usize>,
    /// Steps that were reached since the last look.
    reached: Vec<u16>,
}

/// How far the mission has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Progress {
    /// It waits for its start.
    #[default]
    NotStarted,
    /// It has begun.
    Started,
    /// Its last step is done.
    Complete,
}

impl Mission {
    /// A mission that waits for its start.
    pub fn new(program: Program) -> Self {
        Self { current: program.first(), program, ..Self::default() }
    }

    /// Its steps.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// How far it has come.
    pub fn progress(&self) -> Progress {
        self.progress
    }

    /// Whether it has begun, and is not complete.
    pub fn is_started(&self) -> bool {
        self.progress == Progress::Started
    }

    /// Number of the step that is flown, or will be.
    pub fn current(&self) -> usize {
        self.current
    }

    /// Whether somebody has chosen the step.
    pub fn is_chosen(&self) -> bool {
        self.chosen
    }

    /// Whether it flies its landing in place of a way home.
    pub fn lands(&self) -> bool {
        self.lands
    }

    /// From now on it does.
    pub fn land(&mut self) {
        self.lands = true;
    }

    /// Whether it waits in its own mode.
    pub fn is_paused(&self) -> bool {
        self.paused
    }

    /// Steps that were reached since the last call.
    pub fn take_reached(&mut self) -> Vec<u16> {
        std::mem::take(&mut self.reached)
    }

    /// Beginning and end of the way that is flown, NED, m, if one is.
    pub fn way_m(&self) -> Option<[Vector3<f64>; 2]> {
        self.course.way_m()
    }

    /// Where the present step leads that waits to begin, NED, m, from a place; `home_z_m` is z of home.
    pub fn coming_m(&self, from_m: &Vector3<f64>, home_z_m: f64) -> Option<Vector3<f64>> {
        let step =
            self.program.navigate(self.current).filter(|_| self.is_started() && !self.course.is_busy())?;
        leg_end_m(&step, from_m, home_z_m)
    }

    /// The line that is followed, two places on it, NED, m.
    pub fn line_m(&self) -> Option<[Vector3<f64>; 2]> {
        self.course.line_m()
    }

    /// Whether the way home is flown as a part of it.
    pub fn returns(&self) -> bool {
        self.course.returns()
    }

    /// Turns as a command asks; the rest goes on.
    pub fn turn_by_command(&mut self, turn: &StepTurn, situation: &Situation) {
        self.actions.turn_to(turn, situation);
    }

    /// Starts, or goes on; `first` is the number of the step to begin with.
    ///
    /// # Errors
    /// [`Refusal`] without a mission, for one that the fence forbids, and for a step that there is not.
    pub fn start(
        &mut self,
        situation: &Situation,
        proposal: &mut Proposal,
        first: Option<usize>,
    ) -> Result<(), Refusal> {
        if !self.program.is_flown() {
            return Err(Refusal::later("Mission rejected: no mission uploaded"));
        }
        let begins = first.is_none() && self.progress == Progress::NotStarted;
        check_reach(situation, &self.program)
            .and_then(|()| check_way(situation, &self.program, begins))
            .map_err(|fault| fault.located(situation.identity))
            .map_err(|reason| Refusal::denied(format!("Mission rejected: {reason}")))?;
        if let Some(first) = first {
            self.set_current(situation, proposal, first, true)?;
            if situation.mode != Mode::Mission {
                // It begins at that one, also where a mission that was left begins anew.
                self.progress = Progress::NotStarted;
            }
        }
        self.paused = false;
        if situation.mode != Mode::Mission {
            proposal.enter(Mode::Mission);
        } else if self.progress == Progress::Complete {
            self.begin(situation, proposal);
        } else if !self.course.is_busy() {
            self.take_over(situation, proposal);
        }
        Ok(())
    }

    /// Waits in the mission's own mode.
    pub fn pause(&mut self, situation: &Situation, proposal: &mut Proposal) {
        self.paused = true;
        self.course.give_up(None);
        proposal.hold(situation);
        proposal.say(Severity::Info, "Mission paused");
    }

    /// Whether there is something to go on with.
    ///
    /// # Errors
    /// [`Refusal`] when nothing was paused.
    pub fn may_continue(&self) -> Result<(), Refusal> {
        if self.progress == Progress::Started && self.program.is_flown() {
            Ok(())
        } else {
            Err(Refusal::denied("No paused mission to continue"))
        }
    }

    /// Makes a step the present one; with `reset` the jumps count anew.
    ///
    /// # Errors
    /// [`Refusal`] for a step that there is not.
    pub fn set_current(
        &mut self,
        situation: &Situation,
        proposal: &mut Proposal,
        index: usize,
        reset: bool,
    ) -> Result<(), Refusal> {
        let count = self.program.len();
        if index >= count {
            let reason = format!("Mission item {index} does not exist; the mission has {count}");
            return Err(Refusal::denied(reason));
        }
        if reset {
            self.jumps.clear();
        }
        if self.progress == Progress::Complete {
            self.progress = Progress::NotStarted;
        }
        self.give_up(None);
        self.lands = false;
        self.chosen = index > 0;
        self.current = index.max(self.program.first());
        if situation.mode == Mode::Mission && !self.paused {
            self.take_over(situation, proposal);
        }
        Ok(())
    }

    /// Takes other steps: a new mission begins at its first one, an amended one goes on where it was.
    pub fn replace(
        &mut self,
        situation: &Situation,
        proposal: &mut Proposal,
        program: Program,
        amended: bool,
    ) {
        if amended {
            self.program = program;
        } else {
            proposal.change_speeds(SpeedChange::ForgetMission);
            proposal.look_at(None);
            *self = Self { reached: self.take_reached(), ..Self::new(program) };
        }
        self.give_up(None);
        if situation.mode != Mode::Mission {
            return;
        }
        if self.program.is_flown() {
            self.take_over(situation, proposal);
        } else if situation.armed || !situation.identity.is_ardupilot() {
            proposal.say(Severity::Warning, "Mission cleared: holding");
            proposal.enter(Mode::Hold);
        }
    }

    /// Home has another height: the present leg begins again, to where its altitude is now.
    pub fn heed_home(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let flies = situation.mode == Mode::Mission && self.progress == Progress::Started && !self.paused;
        if flies && self.course.way_m().is_some() {
            self.give_up(None);
            self.take_over(situation, proposal);
        }
    }

    /// Its mode is entered.
    pub fn enter(&mut self, situation: &Situation, proposal: &mut Proposal) {
        match self.progress {
            Progress::Started if situation.conduct.mission_restarts && !self.lands => {
                self.begin(situation, proposal);
            }
            Progress::NotStarted | Progress::Started => self.take_over(situation, proposal),
            Progress::Complete => self.begin(situation, proposal),
        }
    }

    /// The vehicle is armed in its mode, which may have stayed from the flight before: what is complete is flown again.
    pub fn arm(&mut self, situation: &Situation, proposal: &mut Proposal) {
        if self.progress == Progress::Complete {
            self.begin(situation, proposal);
        } else {
            self.take_over(situation, proposal);
        }
    }

    /// Its mode is left.
    pub fn leave(&mut self, proposal: &mut Proposal) {
        (self.paused, self.lands) = (false, false);
        self.course.give_up(None);
        proposal.change_speeds(SpeedChange::InMission(false));
    }

    /// Other limits of speed hold now.
    pub fn replan(&mut self, situation: &Situation, proposal: &Proposal) {
        let route = Route::new(&self.program, self.current, &self.jumps, situation, proposal);
        self.course.replan(&route, situation);
    }

    /// One tick in its mode. Returns who steers.
    pub fn step(&mut self, situation: &Situation, proposal: &mut Proposal) -> Helm {
        if self.paused || self.progress == Progress::Complete {
            proposal.turn_to_region(situation);
            return Helm::Mission;
        }
        if situation.landed && !situation.mission_may_take_off {
            if proposal.steering().kind() != SteeringKind::Idle {
                proposal.idle(situation);
            }
            return Helm::Mission;
        }
        let returned = self.course.returns();
        // An attitude that was left behind, or a stick: the mission flies by position.
        if proposal.steering().kind() == SteeringKind::Attitude {
            proposal.follow(situation, &PositionSetPoint::HOLD);
        }
        self.progress = Progress::Started;
        if self.fly(situation, proposal) {
            self.act(situation, proposal);
            match (returned, self.course.returns()) {
                (_, false) => self.turn(situation, proposal),
                (false, true) => return Helm::ReturnBegins,
                (true, true) => return Helm::Return,
            }
        }
        Helm::Mission
    }

    /// Flies one step after the other, as far as they are done. Returns whether the mission goes on.
    fn fly(&mut self, situation: &Situation, proposal: &mut Proposal) -> bool {
        for _ in 0..STEPS_PER_TICK {
            let step = match self.program.step(self.current) {
                Some(Step::Navigate(step)) => step,
                Some(_) => {
                    if !self.go_on_from(self.current, situation, proposal) {
                        return false;
                    }
                    continue;
                }
                None => {
                    self.complete(situation, proposal);
                    return false;
                }
            };
            if self.told.replace(self.current) != Some(self.current) {
                announcement::begin(&step, self.current, situation, proposal);
            }
            let route = Route::new(&self.program, self.current, &self.jumps, situation, proposal);
            match self.course.step(&step, &route, situation, proposal) {
                TaskProgress::Going => break,
                TaskProgress::Staying => {
                    self.reach(self.current);
                    break;
                }
                TaskProgress::Again => {}
                TaskProgress::Done(turn) => {
                    if !self.finish(&step, turn, situation, proposal) {
                        return false;
                    }
                }
            }
        }
        true
    }

    /// The present step is done. Returns whether the mission goes on.
    fn finish(
        &mut self,
        step: &Navigate,
        turn: Option<Turn>,
        situation: &Situation,
        proposal: &mut Proposal,
    ) -> bool {
        let index = self.current;
        announcement::end(step, index, situation, proposal);
        self.give_up(turn);
        self.reach(index);
        if *step == Navigate::ReturnToLaunch {
            self.complete(situation, proposal);
            if !situation.identity.is_ardupilot() && proposal.steering().kind() != SteeringKind::Idle {
                proposal.enter(Mode::Return);
            }
            return false;
        }
        if self.program.continues_after(index) {
            return self.go_on_from(index + 1, situation, proposal);
        }
        self.current = index + 1;
        proposal.say(
            Severity::Info,
            format!("Mission paused after item {}", situation.identity.item_number(index)),
        );
        proposal.enter(Mode::Hold);
        false
    }

    /// Looks for the next step that is flown; what lies before it is done on the way. Returns whether there is one.
    fn go_on_from(&mut self, index: usize, situation: &Situation, proposal: &mut Proposal) -> bool {
        let next = self.jumps.next(&self.program, index);
        next.jumps.into_iter().for_each(|jump| self.reach(jump));
        self.actions.begin(next.actions);
        if let Some(index) = next.navigation {
            self.current = index;
            return true;
        }
        self.act(situation, proposal);
        self.complete(situation, proposal);
        false
    }

    fn act(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let done = self.actions.act(&self.program, self.course.way_m(), situation, proposal);
        done.into_iter().for_each(|index| self.reach(index));
    }

    /// Turns the vehicle to where it is to look.
    fn turn(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let turned = self.actions.turn();
        let yaw_rad = match proposal.steering() {
            Steering::Goal(goal) => goal.yaw_rad,
            Steering::Path(path) => path.goal().yaw_rad,
            _ => {
                match turned.filter(|_| self.course.is_curved()) {
                    Some(turned) => proposal.turn_on(Some(turned)),
                    None => proposal.turn_to_region(situation),
                }
                return;
            }
        };
        let next_m = self.course.way_m().map(|[_, end_m]| end_m);
        let heading = match (turned, proposal.region()) {
            (Some(turned), _) => turned,
            (None, Some(region)) => {
                // What is too near to be looked at does not turn the vehicle.
                region.heading(&situation.outputs.setpoint, next_m).unwrap_or((yaw_rad, 0.0))
            }
            (None, None) if self.course.heading_is_asked() => (self.course.heading_rad(), 0.0),
            (None, None) => {
                let policy = HeadingPolicy::of(situation);
                let heading_rad = policy.heading_rad(Purpose::Mission, self.course.heading_rad(), situation);
                (heading_rad.unwrap_or(yaw_rad), 0.0)
            }
        };
        proposal.turn_on(Some(heading));
    }

    /// Begins with the first step.
    fn begin(&mut self, situation: &Situation, proposal: &mut Proposal) {
        self.give_up(None);
        self.jumps.clear();
        proposal.look_at(None);
        proposal.change_speeds(SpeedChange::ForgetMission);
        self.progress = Progress::NotStarted;
        self.chosen = false;
        self.current = self.program.first();
        self.take_over(situation, proposal);
    }

    /// The next flight begins with the first step. A mission that is complete says so until then.
    pub fn begin_anew(&mut self, proposal: &mut Proposal) {
        if self.progress == Progress::Started {
            proposal.change_speeds(SpeedChange::ForgetMission);
            self.give_up(None);
            self.jumps.clear();
            (self.progress, self.chosen) = (Progress::NotStarted, false);
            self.current = self.program.first();
        }
    }

    /// Goes on from where the vehicle is.
    fn take_over(&mut self, situation: &Situation, proposal: &mut Proposal) {
        self.told = None;
        proposal.change_speeds(SpeedChange::InMission(true));
        self.course.take_over(situation, proposal);
    }

    /// Gives up what is done for the present step and on the way to it.
    fn give_up(&mut self, turn: Option<Turn>) {
        self.course.give_up(turn);
        self.actions.clear();
        self.told = None;
    }

    fn complete(&mut self, situation: &Situation, proposal: &mut Proposal) {
        self.give_up(None);
        self.progress = Progress::Complete;
        self.current = self.program.len().saturating_sub(1);
        proposal.say(Severity::Info, "Mission complete");
        // On the ground the vehicle disarms in its mode, as after any landing.
        if !situation.identity.is_ardupilot() && proposal.steering().kind() != SteeringKind::Idle {
            proposal.enter(Mode::Hold);
        }
    }

    fn reach(&mut self, index: usize) {
        self.reached.push(u16::try_from(index).unwrap_or(u16::MAX));
    }
}
