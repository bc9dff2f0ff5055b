//! The way home: climb, travel, descend.

use std::collections::VecDeque;

use nalgebra::Vector3;

use super::descent::descend;
use super::notice::Severity;
use super::proposal::Proposal;
use super::set_point::{AxisTarget, PositionSetPoint, YawTarget};
use super::situation::Situation;
use super::steering::Steering;
use crate::fence::route_m;

/// Part of the way home.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
enum Phase {
    /// To the height of the way.
    #[default]
    Climb,
    /// Above the place to land at.
    Travel,
    /// Down.
    Descend,
}

/// So near to a goal, m, and so slow, m/s, the next phase begins.
const REACHED_M: f64 = 0.5;
const SLOW_M_S: f64 = 0.5;

/// A return.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Return {
    phase: Phase,
    /// What is left of the way: north and east, m, the place to land at last.
    way_m: VecDeque<[f64; 2]>,
}

impl Return {
    /// Begins the way home.
    pub fn begin(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let [x, y] = nearest_safe_point_m(situation);
        self.way_m = way_m(situation, proposal, [x, y]);
        let place = situation.outputs.position_m;
        let near = libm::hypot(place.x - x, place.y - y) < situation.conduct.return_near_m;
        if near {
            self.phase = Phase::Descend;
            proposal.say(Severity::Info, "Returning: the place is near, landing");
        } else {
            self.phase = Phase::Climb;
            go_at_return_height(situation, proposal, situation.outputs.setpoint.position_m.xy().into());
        }
    }

    /// One tick of the way home.
    pub fn step(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let reached = || goal_is_reached(situation, proposal.steering());
        match self.phase {
            Phase::Climb if reached() => {
                self.phase = Phase::Travel;
                self.travel(situation, proposal);
            }
            Phase::Travel if reached() && self.way_m.len() > 1 => {
                self.way_m.pop_front();
                self.travel(situation, proposal);
            }
            Phase::Travel if reached() => {
                self.phase = Phase::Descend;
                proposal.say(Severity::Info, "Above the place to return to, landing");
            }
            Phase::Descend => descend(situation, proposal, self.way_m.back().copied()),
            _ => {}
        }
    }

    /// Whether it is above the place, and descends.
    pub fn descends(&self) -> bool {
        self.phase == Phase::Descend
    }

    fn travel(&self, situation: &Situation, proposal: &mut Proposal) {
        if let Some(next) = self.way_m.front() {
            go_at_return_height(situation, proposal, *next);
        }
    }
}

fn go_at_return_height(situation: &Situation, proposal: &mut Proposal, [x, y]: [f64; 2]) {
    let home_z = situation.home.position_m.z;
    let mut z = situation.outputs.position_m.z.min(home_z - situation.conduct.return_height_m);
    if let Some(ceiling_z) = situation.fence_ceiling_z_m() {
        z = z.max(ceiling_z);
    }
    let axes = [AxisTarget::Position(x), AxisTarget::Position(y), AxisTarget::Position(z)];
    proposal.follow(situation, &PositionSetPoint { axes, yaw: YawTarget::Hold });
}

/// Whether the vehicle has come to rest at the goal of the shaper.
fn goal_is_reached(situation: &Situation, steering: &Steering) -> bool {
    let Steering::Goal(goal) = steering else { return false };
    let outputs = situation.outputs;
    (outputs.position_m - goal.position_m).norm() < REACHED_M && outputs.velocity_m_s.norm() < SLOW_M_S
}

/// Where a return goes: to the nearest of home, the rally points and the fence's return point that the fence allows; home if
/// it allows none. North and east, m.
fn nearest_safe_point_m(situation: &Situation) -> [f64; 2] {
    let home = situation.home.position_m;
    let rally = situation.rally_points.iter().filter_map(|place| place.horizontal_m);
    let here = situation.outputs.position_m.xy();
    let distance = |[x, y]: &[f64; 2]| libm::hypot(x - here.x, y - here.y);
    core::iter::once([home.x, home.y])
        .chain(rally)
        .chain(situation.zones.return_m)
        .filter(|[x, y]| situation.breach_at(&Vector3::new(*x, *y, home.z)).is_none())
        .min_by(|one, other| distance(one).total_cmp(&distance(other)))
        .unwrap_or([home.x, home.y])
}

/// The way to a place, north and east, m, around what the fence forbids; straight if there is none.
fn way_m(situation: &Situation, proposal: &mut Proposal, goal: [f64; 2]) -> VecDeque<[f64; 2]> {
    let here = situation.outputs.setpoint.position_m;
    let way = match situation.fence().and_then(|fence| fence.zones) {
        Some(zones) => route_m(zones, [here.x, here.y], goal),
        None => Some(vec![goal]),
    };
    if way.is_none() {
        proposal.say(Severity::Warning, "No way around the fence: returning straight");
    }
    way.unwrap_or_else(|| vec![goal]).into()
}
