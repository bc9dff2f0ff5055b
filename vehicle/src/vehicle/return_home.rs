//! The way home: climb, travel, wait, descend.
//!
//! ```text
//!  Along ───────────────────────────────────────► Descend   PX4 along the mission
//!  Climb ─► Travel ─┬─────────────────────────────► Descend
//!                   ├─► Lower ─► Wait ─────────────► Descend   PX4 with RTL_LAND_DELAY
//!                   └─► Wait ─┬────────────────────► Descend   ArduPilot
//!                             └─► Stay, at RTL_ALT_FINAL
//! ```

use std::collections::VecDeque;

use nalgebra::Vector3;

use super::descent::descend;
use super::ground_way::{GroundWay, headed};
use super::heading_policy::{HeadingPolicy, Purpose};
use super::mission_return::MissionReturn;
use super::motion::wrapped;
use super::notice::Severity;
use super::proposal::Proposal;
use super::return_goals::{distance_m, safe_points_m};
use super::return_height::{follows_ground, way_z_m};
use super::set_point::{AxisTarget, PositionSetPoint, YawTarget};
use super::situation::Situation;
use super::speeds::SpeedChange;
use super::spline::Spline;
use super::steering::Steering;
use super::tick::TICK_S;
use crate::fence::{Progress, RouteSearch};

/// Part of the way home.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
enum Phase {
    /// To the height of the way.
    #[default]
    Climb,
    /// Along the places of the mission.
    Along,
    /// Above the place to land at.
    Travel,
    /// Down to the height at which it waits.
    Lower,
    /// Above the place until a time, µs, or for ever.
    Wait(Option<u64>),
    /// Down to where it stays.
    Stay,
    /// Down.
    Descend,
}

/// So near to a goal, m, and so slow, m/s, the next phase begins.
const REACHED_M: f64 = 0.5;
const SLOW_M_S: f64 = 0.5;
/// So near to its heading, rad, ArduPilot lands.
const TURNED_RAD: f64 = 0.035;

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
    /// What is left of the mission's places, NED, m.
    places_m: VecDeque<Vector3<f64>>,
    /// Height of the way, z, m.
    way_z_m: f64,
    /// The part of it that follows the ground, and the piece of its curve.
    ground_way: Option<(GroundWay, Spline)>,
}

impl Return {
    /// Begins the way home.
    pub fn begin(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let goals_m = safe_points_m(situation);
        let distance_m = goals_m.front().map_or(f64::INFINITY, |goal| distance_m(situation, *goal));
        let way_z_m = way_z_m(situation, distance_m);
        *self = Self { goals_m, way_z_m, ..Self::default() };
        let speed_m_s = situation.conduct.return_home.speed_m_s;
        if situation.identity.is_ardupilot() && speed_m_s > 0.0 {
            proposal.change_speeds(SpeedChange::Return(Some(speed_m_s)));
        }
        self.search_next(situation, proposal);
        self.search_on(situation, proposal);
        if self.phase == Phase::Climb {
            // The heading stays on the way up.
            self.go_above(situation.outputs.setpoint.position_m.xy().into(), situation, proposal);
        }
    }

    /// Begins a way along the mission.
    pub fn begin_along(&mut self, way: MissionReturn, situation: &Situation, proposal: &mut Proposal) {
        let way_m = [way.landing_m].into();
        *self = Self { phase: Phase::Along, places_m: way.places_m, way_m, ..Self::default() };
        self.go_along(situation, proposal);
    }

    /// To the next of the mission's places, with the nose there; above the last it lands.
    fn go_along(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let Some(place_m) = self.places_m.pop_front() else {
            self.phase = Phase::Descend;
            proposal.say(Severity::Info, "At the end of the mission's way: landing");
            return;
        };
        go_to([place_m.x, place_m.y], place_m.z, situation, proposal);
        turn_on_the_way(situation, proposal);
    }

    /// One tick of the way home.
    pub fn step(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let travels = matches!(self.phase, Phase::Climb | Phase::Travel);
        if travels && self.fence_has_changed(situation) {
            self.begin(situation, proposal);
        }
        self.search_on(situation, proposal);
        let reached = || goal_is_reached(situation, proposal.steering());
        match self.phase {
            Phase::Along if reached() => self.go_along(situation, proposal),
            Phase::Along => turn_on_the_way(situation, proposal),
            // It waits there for the way.
            Phase::Climb if !self.way_m.is_empty() && reached() => {
                self.phase = Phase::Travel;
                self.travel(situation, proposal);
            }
            Phase::Travel if self.ground_way.is_some() => self.follow_ground(situation, proposal),
            Phase::Travel if reached() && self.way_m.len() > 1 => {
                self.way_m.pop_front();
                self.travel(situation, proposal);
            }
            Phase::Travel if reached() => self.arrive(situation, proposal),
            Phase::Travel => turn_on_the_way(situation, proposal),
            Phase::Lower if reached() => self.wait(situation, proposal),
            Phase::Wait(Some(until_us)) if situation.time_us >= until_us && has_turned(situation) => {
                self.go_down(situation, proposal);
            }
            Phase::Descend => {
                descend(situation, proposal, self.way_m.back().copied());
                if !situation.identity.is_ardupilot() && !situation.landed {
                    proposal.turn_on(Some((situation.home.yaw_rad, 0.0)));
                }
            }
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

    fn travel(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let Some(next) = self.way_m.front().copied() else { return };
        if follows_ground(situation) {
            let here_m = situation.outputs.setpoint.position_m;
            let above_m = situation.ground_z_m() - here_m.z;
            let way =
                GroundWay::new(here_m, Vector3::new(next[0], next[1], situation.terrain.z_m(next) - above_m));
            let spline = ground_piece(&way, None, situation);
            self.ground_way = spline.map(|spline| (way, spline));
            if self.ground_way.is_some() {
                return;
            }
        }
        self.go_above(next, situation, proposal);
        turn_on_the_way(situation, proposal);
    }

    /// One tick along the ground; the last piece ends at rest, at the goal of the shaper.
    fn follow_ground(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let Some((way, mut spline)) = self.ground_way.take() else { return };
        if let Some(set_point) = spline.step(TICK_S) {
            let way_rad = way.bearing_rad().unwrap_or(situation.outputs.setpoint.yaw_rad);
            proposal.follow(situation, &headed(set_point, Purpose::Return, way_rad, situation));
            self.ground_way = Some((way, spline));
            return;
        }
        self.ground_way = ground_piece(&way, Some(&spline), situation).map(|next| (way, next));
        match self.ground_way {
            Some(_) => self.follow_ground(situation, proposal),
            None => {
                self.way_z_m = way.end_m().z;
                self.go_above(way.end_m().xy().into(), situation, proposal);
            }
        }
    }

    /// To a place at the height of the way; the heading goes on.
    fn go_above(&self, place: [f64; 2], situation: &Situation, proposal: &mut Proposal) {
        go_to(place, self.way_z_m, situation, proposal);
    }

    /// It is above the place.
    fn arrive(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let settings = &situation.conduct.return_home;
        if situation.identity.is_ardupilot() {
            self.wait(situation, proposal);
            if turns_home(situation) {
                proposal.turn_on(Some((situation.home.yaw_rad, 0.0)));
            }
        } else if settings.wait_s == 0.0 {
            self.go_down(situation, proposal);
        } else {
            self.phase = Phase::Lower;
            let z_m = self.way_z_m.max(situation.home.position_m.z - settings.wait_height_m);
            if let Some(place) = self.way_m.back() {
                go_to(*place, z_m, situation, proposal);
                proposal.turn_on(Some((situation.home.yaw_rad, 0.0)));
            }
        }
    }

    fn wait(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let wait_s = situation.conduct.return_home.wait_s;
        if wait_s < 0.0 {
            proposal.say(Severity::Info, "Above the return point: holding");
        }
        self.phase = Phase::Wait((wait_s >= 0.0).then(|| situation.after_us(wait_s)));
        if wait_s == 0.0 && has_turned(situation) {
            self.go_down(situation, proposal);
        }
    }

    /// It lands, or goes down to where it stays.
    fn go_down(&mut self, situation: &Situation, proposal: &mut Proposal) {
        let final_m = situation.conduct.return_home.final_height_m;
        if situation.identity.is_ardupilot() && final_m > 0.0 {
            self.phase = Phase::Stay;
            let z_m = situation.home.position_m.z - final_m;
            if let Some(place) = self.way_m.back() {
                go_to(*place, z_m, situation, proposal);
            }
            return;
        }
        self.phase = Phase::Descend;
        proposal.say(Severity::Info, "Above the return point: landing");
    }
}

/// The next piece of a way that follows the ground: the first one from rest, the others in full motion. `None` at its end.
fn ground_piece(way: &GroundWay, before: Option<&Spline>, situation: &Situation) -> Option<Spline> {
    let onward = match before {
        Some(before) => Some(before.onward(situation.time_us)?),
        None => None,
    };
    let here_m = onward.map_or(situation.outputs.setpoint.position_m, |onward| onward.position_m);
    way.piece(here_m, onward, situation)
}

/// To a place and a height, z, m; the heading goes on.
fn go_to([x, y]: [f64; 2], z_m: f64, situation: &Situation, proposal: &mut Proposal) {
    let axes = [AxisTarget::Position(x), AxisTarget::Position(y), AxisTarget::Position(z_m)];
    proposal.follow(situation, &PositionSetPoint { axes, yaw: YawTarget::Hold });
}

/// Turns the nose as the parameter says.
fn turn_on_the_way(situation: &Situation, proposal: &mut Proposal) {
    /// Nearer than this, m, the goal has no direction.
    const TOO_NEAR_M: f64 = 1.0;
    let Steering::Goal(goal) = proposal.steering() else { return };
    let way = (goal.position_m - situation.outputs.setpoint.position_m).xy();
    let next_rad = if way.norm() > TOO_NEAR_M { libm::atan2(way.y, way.x) } else { goal.yaw_rad };
    let heading_rad = HeadingPolicy::of(situation).heading_rad(Purpose::Return, next_rad, situation);
    if let Some(heading_rad) = heading_rad.filter(|heading_rad| *heading_rad != goal.yaw_rad) {
        proposal.turn_on(Some((heading_rad, 0.0)));
    }
}

/// Whether ArduPilot turns to the heading of home before it lands.
fn turns_home(situation: &Situation) -> bool {
    !matches!(HeadingPolicy::of(situation), HeadingPolicy::Hold | HeadingPolicy::NextPlaceExceptReturn)
}

/// Whether it points where it is to point before it lands.
fn has_turned(situation: &Situation) -> bool {
    let off_rad = wrapped(situation.outputs.attitude_rad.z - situation.home.yaw_rad).abs();
    !situation.identity.is_ardupilot() || !turns_home(situation) || off_rad <= TURNED_RAD
}

/// Whether the vehicle has come to rest at the goal of the shaper.
fn goal_is_reached(situation: &Situation, steering: &Steering) -> bool {
    let Steering::Goal(goal) = steering else { return false };
    let outputs = situation.outputs;
    (outputs.position_m - goal.position_m).norm() < REACHED_M && outputs.velocity_m_s.norm() < SLOW_M_S
}

#[cfg(test)]
mod tests {
    use super::{Return, safe_points_m};
    use crate::fence::{Shape, Zone};
    use crate::plan::Place;
    use crate::vehicle::return_settings::ReturnGoal;
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

    /// Goes from place to place until it descends or stays; the heights above home that it was led to, m.
    fn heights(mut scene: Scene) -> Vec<f64> {
        let mut way_home = Return::default();
        scene.show(|situation, proposal| way_home.begin(situation, proposal));
        let mut heights: Vec<f64> = Vec::new();
        for _ in 0..40 {
            let Some(goal) = scene.goal_m() else { break };
            let height = (-goal[2] * 100.0).round() / 100.0;
            if heights.last() != Some(&height) {
                heights.push(height);
            }
            scene.come_to(goal, [0.0; 3]);
            scene.wait_us(1_000_000);
            step(&mut way_home, &mut scene);
        }
        heights
    }

    #[test]
    fn ardupilot_stays_at_its_final_height_and_px4_waits_at_its_own() {
        let mut scene = Scene::hovering_at([40.0, 0.0, -5.0]).of_ardupilot();
        scene.conduct.return_home.final_height_m = 3.0;
        assert_eq!(heights(scene), [15.0, 3.0]);
        for wait_s in [2.0, -1.0] {
            let mut scene = Scene::hovering_at([40.0, 0.0, -5.0]);
            scene.conduct.return_home.wait_s = wait_s;
            scene.conduct.return_home.wait_height_m = 12.0;
            assert_eq!(heights(scene), [30.0, 12.0]);
        }
    }

    #[test]
    fn rally_points_go_first_if_they_are_to() {
        let mut scene = Scene::hovering_at([4.0, 0.0, -30.0]);
        let horizontal_m = Some([50.0, 0.0]);
        scene.rally_points = vec![Place { horizontal_m, altitude: None }];
        let mut goal = |goal| {
            scene.conduct.return_home.goal = goal;
            safe_points_m(&scene.situation()).front().copied()
        };
        assert_eq!(goal(ReturnGoal::Nearest), Some([0.0, 0.0]));
        assert_eq!(goal(ReturnGoal::RallyPoint), Some([50.0, 0.0]));
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
        while !way_home.descends() {
            scene.come_to(scene.goal_m().unwrap(), [0.0; 3]);
            step(&mut way_home, &mut scene);
        }
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
