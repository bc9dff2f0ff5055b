//! Steps on the way from one place to the next: conditions, and what is done at once.

use std::collections::VecDeque;

use nalgebra::{Vector2, Vector3};

use super::super::commanded_turn::heading_now;
use super::super::notice::Severity;
use super::super::proposal::Proposal;
use super::super::region::RegionOfInterest;
use super::super::situation::Situation;
use super::super::speeds::SpeedChange;
use super::super::tick::TICK_S;
use super::super::turning::Turning;
use crate::equipment::Operation;
use crate::plan::step::{Condition, Do, Step, Turn};
use crate::plan::{Place, Program};

/// What is still to be done on the way.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Actions {
    /// Numbers of the steps.
    steps: VecDeque<usize>,
    /// What the first of them waits for.
    waiting: Option<Waiting>,
    /// The turn that is made, and held until the leg ends.
    turning: Option<Turning>,
}

/// What the next step waits for.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Waiting {
    /// A time, µs.
    Until(u64),
    /// Nearer than this to the end of the leg, m.
    Within(f64),
    /// Beyond the plane through a place, north and east, m.
    Beyond([f64; 2]),
    /// The end of the turn.
    Turned,
}

impl Actions {
    /// Steps that are to be done from now on.
    pub fn begin(&mut self, steps: Vec<usize>) {
        self.steps = steps.into();
    }

    /// Drops what still waits, at the end of a leg; without a leg to come everything else is done.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// Does what is to be done, up to the first condition that is not fulfilled. Returns the steps that are done.
    pub fn act(
        &mut self,
        program: &Program,
        way_m: Option<[Vector3<f64>; 2]>,
        situation: &Situation,
        proposal: &mut Proposal,
    ) -> Vec<usize> {
        let mut done = Vec::new();
        while let Some(index) = self.steps.front().copied() {
            match self.waiting {
                Some(waiting) if !self.is_over(waiting, way_m, situation) => break,
                Some(_) => self.waiting = None,
                None => match program.step(index) {
                    Some(Step::Condition(condition)) => {
                        self.waiting = Some(self.begin_condition(&condition, situation));
                        continue;
                    }
                    Some(Step::Do(action)) => carry_out(&action, situation, proposal),
                    // Jumps are made when the next step is looked for.
                    Some(Step::Navigate(_) | Step::Jump(_) | Step::Pass) => {}
                    None => break,
                },
            }
            self.steps.pop_front();
            done.push(index);
        }
        done
    }

    /// One tick of the turn: heading, rad, and its rate, rad/s, if there is one.
    pub fn turn(&mut self) -> Option<(f64, f64)> {
        let turning = self.turning.as_mut()?;
        turning.step(TICK_S);
        Some(turning.heading())
    }

    fn is_over(&self, waiting: Waiting, way_m: Option<[Vector3<f64>; 2]>, situation: &Situation) -> bool {
        let outputs = situation.outputs;
        match waiting {
            Waiting::Until(time_us) => situation.time_us >= time_us,
            Waiting::Within(distance_m) => {
                way_m.is_some_and(|[_, end_m]| (outputs.position_m - end_m).norm() <= distance_m)
            }
            Waiting::Beyond([x, y]) => way_m.is_some_and(|[_, end_m]| {
                let gate_m = Vector2::new(x, y);
                (outputs.position_m.xy() - gate_m).dot(&(end_m.xy() - gate_m)) >= 0.0
            }),
            Waiting::Turned => self.turning.is_none_or(|turn| turn.is_done(outputs.attitude_rad.z)),
        }
    }

    fn begin_condition(&mut self, condition: &Condition, situation: &Situation) -> Waiting {
        match condition {
            Condition::Delay(time_s) => Waiting::Until(situation.after_us(*time_s)),
            Condition::Distance(distance_m) => Waiting::Within(*distance_m),
            Condition::Gate(place_m) => Waiting::Beyond(*place_m),
            Condition::Yaw(turn) => {
                self.turn_to(turn, situation);
                Waiting::Turned
            }
        }
    }

    /// Turns from the present heading on.
    pub fn turn_to(&mut self, turn: &Turn, situation: &Situation) {
        self.turning = Some(Turning::new(turn, heading_now(situation), situation.limits()));
    }
}

fn carry_out(action: &Do, situation: &Situation, proposal: &mut Proposal) {
    match action {
        Do::ChangeSpeed(change) => proposal.change_speeds(SpeedChange::Mission(*change)),
        Do::SetHome(place) => set_home(place.as_ref(), situation, proposal),
        Do::Operate(operation) => {
            proposal.operate(*operation);
            if let (Operation::Grip { grabs }, true) = (operation, situation.identity.is_ardupilot()) {
                let what = if *grabs { "Grabbed" } else { "Released" };
                proposal.say(Severity::Info, format!("Gripper {what}"));
            }
        }
        Do::SwitchFence(switch) => proposal.switch_fence(*switch),
        Do::MoveSwitch { function, position } => proposal.move_switch(*function, *position),
        Do::Absent(what) => proposal.say(Severity::Info, format!("Mission: no {what}: skipped")),
        Do::Mark => {}
        Do::Look(look) => {
            let home_z_m = proposal.home().position_m.z;
            let here_m = situation.outputs.position_m;
            proposal.look_at(look.as_ref().map(|look| RegionOfInterest::of(look, &here_m, home_z_m)));
        }
    }
}

fn set_home(place: Option<&Place>, situation: &Situation, proposal: &mut Proposal) {
    let home_z_m = proposal.home().position_m.z;
    let at = |place: &Place| {
        let [x, y] = place.horizontal_m?;
        Some(Vector3::new(x, y, place.down_m(home_z_m).unwrap_or(home_z_m)))
    };
    let position_m = place.and_then(at).unwrap_or(situation.outputs.position_m);
    if let Err(refusal) = proposal.set_home(situation, position_m, None) {
        proposal.say(Severity::Warning, format!("Mission: {refusal}"));
    }
}
