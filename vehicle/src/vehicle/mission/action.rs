//! Items on the way from one place to the next: conditions, and what is done at once.

use nalgebra::Vector3;

use super::super::notice::Severity;
use super::super::speeds::SpeedChange;
use super::super::state::Vehicle;
use super::heading::Turn;
use super::task::Task;
use crate::plan::{MissionItem, command};

/// What the next action waits for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Condition {
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
        while let Some(index) = self.machines.mission.actions.front().copied() {
            match self.machines.mission.condition {
                Some(condition) if !self.is_fulfilled(condition) => return,
                Some(_) => self.machines.mission.condition = None,
                None => {
                    let Some(item) = self.mission_items().get(index).copied() else { return };
                    self.machines.mission.condition = self.begin_condition(&item);
                    if self.machines.mission.condition.is_some() {
                        continue;
                    }
                    self.carry_out(&item);
                }
            }
            self.machines.mission.actions.pop_front();
            self.reached_item(index);
        }
    }

    /// Drops what still waits, at the end of a leg; without a leg to come everything else is done.
    pub(super) fn drop_conditions(&mut self) {
        self.machines.mission.condition = None;
        self.machines.mission.turn = None;
        self.machines.mission.actions.clear();
    }

    fn is_fulfilled(&self, condition: Condition) -> bool {
        match condition {
            Condition::Until(time_us) => self.time_us() >= time_us,
            Condition::Within(distance_m) => {
                let Some(Task::Leg(leg, _)) = &self.machines.mission.task else { return false };
                (self.perception.outputs().position_m - leg.to_m).norm() <= distance_m
            }
            Condition::Turned => {
                let yaw_rad = self.perception.outputs().attitude_rad.z;
                self.machines.mission.turn.is_none_or(|turn| turn.is_done(yaw_rad))
            }
        }
    }

    fn begin_condition(&mut self, item: &MissionItem) -> Option<Condition> {
        match item.command {
            command::CONDITION_DELAY => Some(Condition::Until(self.after_s(item.parameter_or(1, 0.0)))),
            command::CONDITION_DISTANCE => Some(Condition::Within(item.parameter_or(1, 0.0))),
            command::CONDITION_YAW => {
                let fastest_rad_s = self.closed_loop.simulation().configuration().limits.yaw_rate_rad_s;
                self.machines.mission.turn =
                    Some(Turn::new(item, self.perception.outputs().setpoint.yaw_rad, fastest_rad_s));
                Some(Condition::Turned)
            }
            _ => None,
        }
    }

    fn carry_out(&mut self, item: &MissionItem) {
        match item.command {
            command::DO_CHANGE_SPEED => {
                let (kind, speed_m_s) = (item.parameter_or(1, 0.0), item.parameter_or(2, -1.0));
                self.consult(|_, _, proposal| {
                    proposal.change_speeds(SpeedChange::Mission { kind, speed_m_s });
                });
            }
            command::DO_SET_HOME => self.set_mission_home(item),
            command::DO_SET_ROI_LOCATION
            | command::DO_SET_ROI_WPNEXT_OFFSET
            | command::DO_SET_ROI_NONE
            | command::DO_SET_ROI => self.look_at(item),
            // Jumps are made when the next item is looked for.
            _ => {}
        }
    }

    fn set_mission_home(&mut self, item: &MissionItem) {
        let here = self.perception.outputs().position_m;
        let place = self.site().place(item).filter(|_| item.parameter_or(1, 0.0) < 0.5);
        let position_m = match place.and_then(|place| Some((place.horizontal_m?, place.down_m))) {
            Some(([x, y], z)) => Vector3::new(x, y, z.unwrap_or(self.decided.home().position_m.z)),
            None => here,
        };
        if let Err(refusal) = self.set_home(position_m, None) {
            self.decided.say(Severity::Warning, format!("Mission: {refusal}"));
        }
    }
}
