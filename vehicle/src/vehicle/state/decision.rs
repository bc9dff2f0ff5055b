//! The one place that decides: it carries out what the machines ask for, in the order in which they ask.

use quadrotor::Configuration;

use super::super::change_error::ChangeError;
use super::super::failsafe::Cause;
use super::super::machines::Machines;
use super::super::mission_return::MissionReturn;
use super::super::notice::Severity;
use super::super::proposal::{Outcome, Proposal, Request};
use super::super::situation::Situation;
use super::super::speeds::{SpeedChange, Speeds, with_speeds};
use super::super::steering::SteeringKind;
use super::{Vehicle, situation};
use crate::mode::Mode;

/// A machine that is shown a situation in its turn, and says what has become of that.
pub(super) type Turn<'a> = &'a mut dyn FnMut(&mut Machines, &Situation, &mut Proposal) -> Shown;

/// What has become of a situation that was shown to a machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shown {
    /// It still tells how things are, as far as nothing was asked for.
    Still,
    /// The machine has changed what it tells.
    Outdated,
    /// It has, and the same machine is to be shown another one.
    Again,
}

impl Shown {
    /// Whether nothing has changed that a situation tells.
    pub(super) fn still_if(unchanged: bool) -> Self {
        if unchanged { Self::Still } else { Self::Outdated }
    }
}

impl Vehicle {
    /// Shows the situation to a machine and carries out what it asks for. Returns the machine's answer.
    pub(super) fn consult<T>(
        &mut self,
        ask: impl FnOnce(&mut Machines, &Situation, &mut Proposal) -> T,
    ) -> T {
        let Self { setup, closed_loop, perception, plans, decided, machines, .. } = self;
        let situation = situation(setup, closed_loop, perception, plans, decided, machines);
        let mut proposal = Proposal::new(&situation);
        let answer = ask(machines, &situation, &mut proposal);
        if proposal.asks_nothing(&situation) {
            return answer;
        }
        let outcome = proposal.into_outcome();
        self.decide(outcome);
        answer
    }

    /// Shows a situation to one machine after the other. A new one is shown as soon as one of them has changed what a situation tells, or
    /// what it asks for has been carried out: mostly one situation serves them all.
    pub(super) fn consult_in_turn(&mut self, turns: &mut [Turn]) {
        let mut next = 0;
        while next < turns.len() {
            // Taken apart here: a situation is large, and made in its place.
            let Self { setup, closed_loop, perception, plans, decided, machines, .. } = self;
            let situation = situation(setup, closed_loop, perception, plans, decided, machines);
            let mut proposal = Proposal::new(&situation);
            while let Some(ask) = turns.get_mut(next) {
                let shown = ask(machines, &situation, &mut proposal);
                next += usize::from(shown != Shown::Again);
                if shown != Shown::Still || !proposal.asks_nothing(&situation) {
                    break;
                }
            }
            if !proposal.asks_nothing(&situation) {
                let outcome = proposal.into_outcome();
                self.decide(outcome);
            }
        }
    }

    fn decide(&mut self, outcome: Outcome) {
        if let Some(steering) = outcome.steering {
            self.decided.steer(steering);
        }
        let has_moved = outcome.home.position_m != self.decided.home().position_m;
        self.decided.move_home(outcome.home);
        if has_moved && self.plans.fence_moves_with_home() {
            let site = self.site();
            self.plans.follow_home(&site);
        }
        if outcome.region.is_some() && outcome.region != self.decided.region() {
            self.machines.equipment.track();
        }
        self.decided.look_at(outcome.region);
        for request in outcome.requests {
            match request {
                Request::Say(notice) => self.decided.pass_on(notice),
                Request::Enter(mode) => self.enter(mode),
                Request::GoOnIn(mode) => {
                    self.decided.switch_to(mode);
                    if mode == Mode::Offboard {
                        // What was asked for before does not lead it.
                        self.machines.offboard.forget();
                    } else {
                        self.machines.offboard.begin();
                    }
                }
                Request::ChangeSpeeds(change) => self.use_speeds_or_say(self.machines.speeds.after(change)),
                Request::See(cause, present) => self.see(cause, present),
                Request::Operate(operation) => {
                    if let Err(refusal) = self.operate(&operation) {
                        self.decided.say(Severity::Warning, format!("Mission: {refusal}"));
                    }
                }
                Request::JoinLanding => {
                    if self.join_landing().is_err() {
                        self.enter(Mode::Return);
                    }
                }
                Request::SwitchFence(switch) => self.switch_fence(switch),
                Request::MoveSwitch(number, position) => {
                    if let Err(refusal) = self.move_switch(number, position) {
                        self.decided.say(Severity::Warning, format!("Mission: {refusal}"));
                    }
                }
                Request::StopRotors(why) => self.stop_rotors(&why),
                Request::Terminate => self.terminate(),
            }
        }
    }

    /// Lets the failsafe take in whether a cause is there.
    pub(super) fn see(&mut self, cause: Cause, present: bool) {
        self.consult(|parts, situation, proposal| {
            parts.failsafe.take_in(situation, proposal, cause, present)
        });
    }

    /// Changes to a mode, whatever speaks against it.
    pub(super) fn enter(&mut self, mode: Mode) {
        // Without a trail it returns as it always does.
        let mode = match mode {
            Mode::SmartReturn if self.machines.smart_return.may_begin().is_err() => Mode::Return,
            _ => mode,
        };
        let before = self.decided.mode();
        if mode != before {
            let name = self.setup.identity().mode_name(mode);
            self.decided.say(Severity::Info, format!("{name} mode"));
        }
        if before == Mode::Mission && mode != Mode::Mission {
            self.consult(|parts, _, proposal| parts.mission.leave(proposal));
        }
        if before != mode && matches!(before, Mode::Return | Mode::Mission) {
            self.consult(|_, _, proposal| proposal.change_speeds(SpeedChange::Return(None)));
        }
        self.decided.switch_to(mode);
        self.machines.takeoff.forget();
        self.machines.turn.forget();
        self.machines.offboard.begin();
        self.machines.stick_flight.forget();
        self.machines.climb.forget();
        self.machines.ground_flight.forget();
        self.consult(|parts, situation, proposal| match mode {
            Mode::Hold | Mode::Position | Mode::PositionHold => proposal.hold(situation),
            Mode::Offboard if !situation.set_points_are_recent => proposal.hold(situation),
            Mode::Mission => parts.mission.enter(situation, proposal),
            Mode::Return if proposal.steering().kind() != SteeringKind::Idle => {
                match MissionReturn::new(&parts.mission, before == Mode::Mission, situation) {
                    Some(way) => parts.return_home.begin_along(way, situation, proposal),
                    None => parts.return_home.begin(situation, proposal),
                }
            }
            Mode::SmartReturn if proposal.steering().kind() != SteeringKind::Idle => {
                parts.smart_return.begin(situation, proposal);
            }
            Mode::Orbit => parts.orbit.begin(situation, proposal),
            Mode::Follow => parts.follow.begin(situation, proposal),
            Mode::Throw => parts.throw.begin(),
            Mode::Flip => parts.flip.begin(before, situation),
            Mode::ZigZag => parts.zigzag.begin(situation, proposal),
            Mode::GuidedAttitude => {
                parts.offboard.forget();
                proposal.hold(situation);
            }
            _ => {}
        });
    }

    /// Lets the main loop hang, until the vehicle boots again.
    pub fn hang(&mut self) {
        let time_us = self.time_us();
        self.machines.boot_fault.hang(time_us);
    }

    /// Ends the flight at once: the rotors stop wherever it is.
    pub fn terminate(&mut self) {
        if self.decided.is_armed() {
            self.decided.terminate();
            self.stop_rotors("Flight terminated");
        }
    }

    /// Stops the rotors, and ends what ends with a flight.
    pub(super) fn stop_rotors(&mut self, why: &str) {
        self.decided.disarm();
        self.machines.landing.disarm();
        self.machines.failsafe.release();
        self.machines.failsafe.forget(Cause::SetPointsLost);
        self.machines.takeoff.forget();
        self.machines.climb.forget();
        self.machines.turn.forget();
        let speeds = self.machines.speeds.after(SpeedChange::Return(None));
        self.use_speeds_or_say(speeds.after(SpeedChange::ForgetCommands));
        self.consult(|_, situation, proposal| {
            proposal.look_at(None);
            proposal.idle(situation);
        });
        let (mode, identity) = (self.decided.mode(), self.setup.identity());
        if mode == Mode::Mission {
            self.consult(|parts, _, proposal| parts.mission.leave(proposal));
        }
        if identity.is_ardupilot() {
            self.consult(|parts, _, proposal| parts.mission.begin_anew(proposal));
        }
        self.decided.switch_to(identity.mode_after_flight(mode));
        self.decided.say(Severity::Info, why);
    }

    pub(super) fn use_speeds_or_say(&mut self, speeds: Speeds) {
        if let Err(error) = self.use_speeds(speeds) {
            self.decided.say(Severity::Warning, format!("Speed not changed: {error}"));
        }
    }

    /// Lets other limits of speed hold.
    pub(super) fn use_speeds(&mut self, speeds: Speeds) -> Result<(), ChangeError> {
        let present = *self.closed_loop.simulation().configuration();
        let configuration = with_speeds(present, speeds.in_force());
        if configuration.limits != present.limits {
            self.configure(&configuration)?;
            self.consult(|parts, situation, proposal| parts.mission.replan(situation, proposal));
        }
        self.machines.speeds = speeds;
        Ok(())
    }

    /// Changes the closed loop's parameters; the speeds that hold for now lie over them.
    pub(super) fn reconfigure(&mut self, kept: &Configuration) -> Result<(), ChangeError> {
        let speeds = self.machines.speeds.keeping(&kept.limits);
        let before = *self.closed_loop.limits().wanted();
        self.configure(&with_speeds(*kept, speeds.in_force()))?;
        self.machines.speeds = speeds;
        if *self.closed_loop.limits().wanted() != before {
            self.consult(|parts, situation, proposal| parts.mission.replan(situation, proposal));
        }
        Ok(())
    }

    fn configure(&mut self, configuration: &Configuration) -> Result<(), ChangeError> {
        self.closed_loop.configure(configuration)?;
        self.perception.look_again(&self.closed_loop);
        Ok(())
    }
}
