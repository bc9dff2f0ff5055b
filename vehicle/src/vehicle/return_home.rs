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
            proposal.say(Severity::Info, "Return point is near: landing");
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
                proposal.say(Severity::Info, "Above the return point: landing");
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
        proposal.say(Severity::Warning, "No route around the fence: returning straight");
    }
    way.unwrap_or_else(|| vec![goal]).into()
}

#[cfg(test)]
mod tests {
    use super::Return;
    use crate::fence::{Shape, Zone};
    use crate::vehicle::scene::{Scene, said};
    use crate::vehicle::steering::{Steering, SteeringKind};

    /// One tick.
    fn step(way_home: &mut Return, scene: &mut Scene) -> Vec<String> {
        let requests = scene.show(|situation, proposal| way_home.step(situation, proposal));
        said(&requests).into_iter().map(str::to_owned).collect()
    }

    #[test]
    fn it_climbs_travels_and_descends() {
        let mut scene = Scene::hovering_at([40.0, 30.0, -10.0]);
        let mut way_home = Return::default();
        let requests = scene.show(|situation, proposal| way_home.begin(situation, proposal));
        assert!(requests.is_empty() && scene.goal_m() == Some([40.0, 30.0, -30.0]), "{requests:?}");
        // As long as it climbs nothing changes.
        scene.come_to([40.0, 30.0, -20.0], [0.0, 0.0, -2.0]);
        assert!(step(&mut way_home, &mut scene).is_empty() && scene.goal_m() == Some([40.0, 30.0, -30.0]));
        scene.come_to([40.0, 30.0, -30.0], [0.0; 3]);
        step(&mut way_home, &mut scene);
        assert_eq!(scene.goal_m(), Some([0.0, 0.0, -30.0]));
        assert!(!way_home.descends());
        scene.come_to([0.0, 0.0, -30.0], [0.0; 3]);
        assert_eq!(step(&mut way_home, &mut scene), ["Above the return point: landing"]);
        assert!(way_home.descends());
        step(&mut way_home, &mut scene);
        assert!(matches!(scene.steering, Steering::Motion(_)), "{:?}", scene.steering);
    }

    #[test]
    fn near_home_it_lands_at_once() {
        let mut scene = Scene::hovering_at([3.0, 0.0, -10.0]);
        let mut way_home = Return::default();
        let requests = scene.show(|situation, proposal| way_home.begin(situation, proposal));
        assert_eq!(said(&requests), ["Return point is near: landing"]);
        assert!(way_home.descends());
    }

    #[test]
    fn the_fence_bounds_its_height_and_bends_its_way() {
        let mut scene = Scene::hovering_at([40.0, 0.0, -10.0]);
        scene.conduct.failsafe.fence_height_m = 12.0;
        let shape = Shape::Circle { centre_m: [20.0, 0.0], radius_m: 5.0 };
        scene.zones.zones.push(Zone { shape, inclusion: false });
        let mut way_home = Return::default();
        scene.show(|situation, proposal| way_home.begin(situation, proposal));
        assert_eq!(scene.goal_m(), Some([40.0, 0.0, -12.0]));
        let mut corners = 0;
        while !way_home.descends() {
            scene.come_to(scene.goal_m().unwrap(), [0.0; 3]);
            step(&mut way_home, &mut scene);
            corners += 1;
            assert!(corners < 20);
        }
        assert!(corners > 3, "straight through: {corners}");
        assert_eq!(scene.goal_m(), Some([0.0, 0.0, -12.0]));
    }

    /// Without a place it goes down level, and idles where it stands.
    #[test]
    fn a_blind_descent_is_level_and_ends_on_the_ground() {
        let mut scene = Scene::hovering_at([1.0, 0.0, -10.0]);
        let mut way_home = Return::default();
        scene.show(|situation, proposal| way_home.begin(situation, proposal));
        scene.validity.horizontal_position = false;
        step(&mut way_home, &mut scene);
        let Steering::Attitude { set_point, .. } = scene.steering else { panic!("{:?}", scene.steering) };
        let hover = scene.configuration.airframe.weight_n() / scene.configuration.airframe.thrust_range_n().1;
        assert!(set_point.thrust < hover && set_point.thrust > 0.5 * hover, "{} {hover}", set_point.thrust);
        scene.landed = true;
        step(&mut way_home, &mut scene);
        assert_eq!(scene.steering.kind(), SteeringKind::Idle);
    }
}
