//! Items on the way from one place to the next: conditions, and what is done at once.

use nalgebra::Vector3;

use super::super::notice::Severity;
use super::super::state::Vehicle;
use super::heading::Turning;
use super::task::Task;
use crate::plan::Place;
use crate::plan::step::{Condition, Do, Step};

/// What the next action waits for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Waiting {
    /// A time, µs.
    Until(u64),
    /// Nearer than this to the end of the leg, m.
    Within(f64),
    /// The end of the turn.
    Turned,
}

impl Vehicle {
    /// Does what is to be done on the way, up to the first condition that is not fulfilled.
    pub(super) fn act(&mut self) {
        while let Some(index) = self.mission.actions.front().copied() {
            match self.mission.waiting {
                Some(waiting) if !self.is_over(waiting) => return,
                Some(_) => self.mission.waiting = None,
                None => match self.mission.program.step(index) {
                    Some(Step::Condition(condition)) => {
                        self.mission.waiting = Some(self.begin_condition(&condition));
                        continue;
                    }
                    Some(Step::Do(action)) => self.carry_out(&action),
                    // Jumps are made when the next step is looked for.
                    Some(Step::Navigate(_) | Step::Jump(_) | Step::Pass) => {}
                    None => return,
                },
            }
            self.mission.actions.pop_front();
            self.reached_item(index);
        }
    }

    /// Drops what still waits, at the end of a leg; without a leg to come everything else is done.
    pub(super) fn drop_conditions(&mut self) {
        self.mission.waiting = None;
        self.mission.turn = None;
        self.mission.actions.clear();
    }

    fn is_over(&self, waiting: Waiting) -> bool {
        match waiting {
            Waiting::Until(time_us) => self.time_us() >= time_us,
            Waiting::Within(distance_m) => {
                let Some(Task::Leg(leg, _)) = &self.mission.task else { return false };
                (self.outputs.position_m - leg.to_m).norm() <= distance_m
            }
            Waiting::Turned => {
                let yaw_rad = self.outputs.attitude_rad.z;
                self.mission.turn.is_none_or(|turn| turn.is_done(yaw_rad))
            }
        }
    }

    fn begin_condition(&mut self, condition: &Condition) -> Waiting {
        match condition {
            Condition::Delay(time_s) => Waiting::Until(self.after_s(*time_s)),
            Condition::Distance(distance_m) => Waiting::Within(*distance_m),
            Condition::Yaw(turn) => {
                let fastest_rad_s = self.simulation.configuration().limits.yaw_rate_rad_s;
                self.mission.turn = Some(Turning::new(turn, self.outputs.setpoint.yaw_rad, fastest_rad_s));
                Waiting::Turned
            }
        }
    }

    fn carry_out(&mut self, action: &Do) {
        match action {
            Do::ChangeSpeed(change) => self.change_mission_speed(change),
            Do::SetHome(place) => self.set_mission_home(place.as_ref()),
            Do::Look(look) => self.look_at(look.as_ref()),
        }
    }

    fn set_mission_home(&mut self, place: Option<&Place>) {
        let home_z_m = self.home.position_m.z;
        let at = |place: &Place| {
            let [x, y] = place.horizontal_m?;
            Some(Vector3::new(x, y, place.down_m(home_z_m).unwrap_or(home_z_m)))
        };
        let position_m = place.and_then(at).unwrap_or(self.outputs.position_m);
        if let Err(refusal) = self.set_home(position_m, None) {
            self.say(Severity::Warning, format!("Mission: {refusal}"));
        }
    }
}
