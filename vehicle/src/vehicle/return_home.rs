//! The way home: climb, travel, descend.

use std::collections::VecDeque;

use nalgebra::Vector3;

use super::descent::descend;
use super::notice::Severity;
use super::proposal::Proposal;
use super::set_point::{AxisTarget, PositionSetPoint, YawTarget};
use super::situation::Situation;
use super::steering::Steering;
use crate::fence::{Progress, RouteSearch};

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

/// So many sides of the fence are looked at in one tick to find the way: a fraction of a millisecond.
const WORK_PER_TICK: u64 = 10_000;

/// A return.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Return {
    phase: Phase,
    /// Where it may go to, north and east, m: those that no way has been looked for yet.
    goals_m: VecDeque<[f64; 2]>,
    /// The search for the way around the fence.
    search: Option<RouteSearch>,
    /// What is left of the way: north and east, m, the place to land at last. Empty until it is found.
    way_m: VecDeque<[f64; 2]>,
}

impl Return {
    /// Begins the way home.
    pub fn begin(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let goals_m = safe_points_m(situation);
        let near = goals_m.front().is_some_and(|goal| is_near(situation, *goal));
        *self = Self { goals_m, ..Self::default() };
        self.search_next(situation, proposal);
        self.search_on(situation, proposal);
        if near && self.phase == Phase::Climb && self.way_m.len() == 1 {
            self.phase = Phase::Descend;
            proposal.say(Severity::Info, "Return point is near: landing");
        } else if self.phase == Phase::Climb {
            go_at_return_height(situation, proposal, situation.outputs.setpoint.position_m.xy().into());
        }
    }

    /// One tick of the way home.
    pub fn step(&mut self, situation: &Situation, proposal: &mut Proposal) {
        if self.phase != Phase::Descend && self.fence_has_changed(situation) {
            self.begin(situation, proposal);
        }
        self.search_on(situation, proposal);
        let reached = || goal_is_reached(situation, proposal.steering());
        match self.phase {
            // It waits there for the way.
            Phase::Climb if !self.way_m.is_empty() && reached() => {
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

    /// Looks for the way to the next of the places that it may go to. Without any left it lands where it is.
    fn search_next(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let here = situation.outputs.setpoint.position_m.xy().into();
        match (self.goals_m.pop_front(), situation.fence()) {
            (Some(goal), Some(fence)) => self.search = Some(RouteSearch::new(&fence, here, goal)),
            (Some(goal), None) => self.way_m = [goal].into(),
            (None, _) => {
                self.phase = Phase::Descend;
                self.way_m = [here].into();
                proposal.say(Severity::Warning, "No route home around the fence: landing here");
            }
        }
    }

    /// Goes on with the search, as far as one tick allows.
    fn search_on(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let Some(search) = self.search.as_mut().filter(|_| self.way_m.is_empty()) else { return };
        match search.advance(WORK_PER_TICK) {
            Progress::Searching => {}
            Progress::Found(way_m) => self.way_m = way_m.into(),
            Progress::None => self.search_next(situation, proposal),
        }
    }

    fn fence_has_changed(&self, situation: &Situation) -> bool {
        match (&self.search, situation.fence()) {
            (Some(search), Some(fence)) => !search.is_around(&fence),
            (None, None) => false,
            _ => true,
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

/// Where a return may go: home, the rally points and the fence's return point, as far as the fence allows them, the nearest
/// first. North and east, m.
fn safe_points_m(situation: &Situation) -> VecDeque<[f64; 2]> {
    let home = situation.home.position_m;
    let rally = situation.rally_points.iter().filter_map(|place| place.horizontal_m);
    let mut points: Vec<[f64; 2]> = core::iter::once([home.x, home.y])
        .chain(rally)
        .chain(situation.zones.return_m)
        .filter(|[x, y]| situation.breach_at(&Vector3::new(*x, *y, home.z)).is_none())
        .collect();
    points.sort_by(|one, other| distance_m(situation, *one).total_cmp(&distance_m(situation, *other)));
    points.into()
}

/// Horizontal distance of a place, m.
fn distance_m(situation: &Situation, [x, y]: [f64; 2]) -> f64 {
    let here = situation.outputs.position_m;
    libm::hypot(x - here.x, y - here.y)
}

fn is_near(situation: &Situation, place: [f64; 2]) -> bool {
    distance_m(situation, place) < situation.conduct.return_near_m
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

    fn circle(north_m: f64, radius_m: f64) -> Zone {
        Zone { shape: Shape::Circle { centre_m: [north_m, 0.0], radius_m }, inclusion: false }
    }

    /// A fence around the nearest point leaves the next one, and one around the vehicle none: it lands where it is.
    #[test]
    fn it_never_goes_through_an_exclusion() {
        let mut scene = Scene::hovering_at([40.0, 0.0, -10.0]);
        // A ring around home.
        let ring = (0..24).map(|index| {
            let angle = f64::from(index) * core::f64::consts::TAU / 24.0;
            let centre_m = [20.0 * angle.cos(), 20.0 * angle.sin()];
            Zone { shape: Shape::Circle { centre_m, radius_m: 4.0 }, inclusion: false }
        });
        scene.zones.zones.extend(ring);
        scene.zones.return_m = Some([100.0, 0.0]);
        let begin = |scene: &mut Scene| {
            let mut way_home = Return::default();
            let mut told = Vec::new();
            let requests = scene.show(|situation, proposal| way_home.begin(situation, proposal));
            told.extend(said(&requests).into_iter().map(str::to_owned));
            scene.come_to([40.0, 0.0, -30.0], [0.0; 3]);
            for _ in 0..2000 {
                told.extend(step(&mut way_home, scene));
            }
            (way_home, told)
        };
        let (way_home, told) = begin(&mut scene);
        assert!(told.is_empty() && !way_home.descends(), "{told:?}");
        assert_eq!(scene.goal_m(), Some([100.0, 0.0, -30.0]));
        scene.zones.return_m = None;
        let (way_home, told) = begin(&mut scene);
        assert_eq!(told, ["No route home around the fence: landing here"]);
        assert!(way_home.descends());
    }

    #[test]
    fn a_fence_that_changes_changes_the_way() {
        let mut scene = Scene::hovering_at([40.0, 0.0, -30.0]);
        let mut way_home = Return::default();
        scene.show(|situation, proposal| way_home.begin(situation, proposal));
        step(&mut way_home, &mut scene);
        assert_eq!(scene.goal_m(), Some([0.0, 0.0, -30.0]));
        scene.zones.zones.push(circle(20.0, 5.0));
        step(&mut way_home, &mut scene);
        step(&mut way_home, &mut scene);
        let [north, east, _] = scene.goal_m().unwrap();
        assert!(north > 20.0 && libm::hypot(north - 20.0, east) > 7.0, "{north} {east}");
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
