//! The way ahead: where legs end, and how fast their corners are passed.

use nalgebra::Vector3;
use quadrotor::Limits;

use super::super::ground_way::{GroundWay, PLACES_AHEAD, leads_along_ground};
use super::super::heading_policy::HeadingPolicy;
use super::super::mission_heading::MissionHeading;
use super::super::proposal::Proposal;
use super::super::situation::Situation;
use super::super::spline::CurvePlaces;
use super::super::trajectory::Blend;
use super::circle_turns::CircleTurns;
use super::jumps::Jumps;
use super::leg::{Leg, Turn, bearing_rad, is_at_rest};
use super::leg_end::{circle, leg_end_m, place_m};
use super::path::{Corner, Start, Stop, first_corner};
use crate::fence::Fence;
use crate::plan::step::{Navigate, Turns};
use crate::plan::{Place, Program};
use crate::surroundings::Terrain;

/// Places that are looked ahead.
const AHEAD: usize = 6;

/// The steps from the present one on, seen from now.
#[derive(Clone, Copy)]
pub struct Route<'a> {
    program: &'a Program,
    /// Number of the present step.
    current: usize,
    jumps: &'a Jumps,
    /// Acceptance radius of steps that have none of their own, m.
    radius_m: f64,
    /// z of home, m.
    home_z_m: f64,
    limits: &'a Limits,
    fence: Option<Fence<'a>>,
    terrain: &'a Terrain,
    /// Whether the nose points to a place before it is flown to.
    faces_first: bool,
    /// How headings that waypoints ask for are waited for, if they are.
    waits_for: Option<MissionHeading>,
    /// Heading now, rad.
    yaw_rad: f64,
}

impl<'a> Route<'a> {
    /// The steps from number `current` on.
    pub fn new(
        program: &'a Program,
        current: usize,
        jumps: &'a Jumps,
        situation: &Situation<'a>,
        proposal: &Proposal,
    ) -> Self {
        Self {
            program,
            current,
            jumps,
            radius_m: situation.conduct.acceptance_radius_m,
            home_z_m: proposal.home().position_m.z,
            limits: situation.limits(),
            fence: situation.fence(),
            terrain: situation.terrain,
            faces_first: HeadingPolicy::of(situation) == HeadingPolicy::NextPlaceFirst,
            waits_for: Some(situation.conduct.mission_heading)
                .filter(|heading| heading.waits() && !situation.identity.is_ardupilot()),
            yaw_rad: situation.outputs.attitude_rad.z,
        }
    }

    /// Where the leg of a step ends that begins at `from_m`, NED, m; `None` if it has none.
    pub fn leg_end_m(&self, step: &Navigate, from_m: &Vector3<f64>) -> Option<Vector3<f64>> {
        leg_end_m(step, from_m, self.home_z_m)
    }

    /// The turns of a vehicle that comes from a place, NED, m.
    pub fn circle(&self, turns: &Turns, from_m: &Vector3<f64>) -> CircleTurns {
        circle(turns, from_m, self.home_z_m)
    }

    /// The places of the present step and of those behind it that are flown along one curve, NED, m, up to the first at which the vehicle
    /// rests.
    pub fn curve_m(&self, from_m: &Vector3<f64>) -> Vec<Vector3<f64>> {
        let mut jumps = self.jumps.clone();
        let mut next = Some(self.current);
        let mut places = CurvePlaces::new(*from_m);
        for _ in 0..AHEAD {
            let step = next.and_then(|index| Some((index, self.program.navigate(index)?)));
            let Some((index, Navigate::Spline { place, hold_s })) = step else { break };
            let place_m = place_m(&place, &places.end_m(), self.home_z_m);
            if places.turns_back(&place_m) {
                break;
            }
            places.push(place_m);
            if hold_s > 0.0 || !self.program.continues_after(index) {
                break;
            }
            next = jumps.next(self.program, index + 1).navigation;
        }
        places.places_m
    }

    /// Whether the way to a step's place follows the ground.
    pub fn follows_ground(&self, step: &Navigate) -> bool {
        leads_along_ground(step, self.terrain)
    }

    /// Places ahead on ways that follow the ground, up to the first at which the vehicle rests: from `here_m` on the present step's,
    /// which begins at `from_m`, NED, m.
    pub fn ground_places_m(&self, from_m: &Vector3<f64>, here_m: &Vector3<f64>) -> Vec<Vector3<f64>> {
        let mut jumps = self.jumps.clone();
        let (mut next, mut from_m, mut here_m) = (Some(self.current), *from_m, *here_m);
        let mut places = CurvePlaces::new(here_m);
        for _ in 0..PLACES_AHEAD {
            let left = PLACES_AHEAD - places.places_m.len();
            let Some(index) = next.filter(|_| left > 0) else { break };
            let step = self.program.navigate(index).filter(|step| self.follows_ground(step));
            let Some((step, end_m)) = step.and_then(|step| Some((step, self.leg_end_m(&step, &from_m)?)))
            else {
                break;
            };
            let way = GroundWay::new(from_m, end_m);
            let mut ahead_m = way.places_m(&here_m, self.terrain).take(left).peekable();
            if ahead_m.peek().is_some_and(|place_m| places.turns_back(place_m)) {
                break;
            }
            ahead_m.for_each(|place_m| {
                places.push(place_m);
            });
            if self.rests_at(index, &step) {
                break;
            }
            next = jumps.next(self.program, index + 1).navigation;
            (from_m, here_m) = (end_m, end_m);
        }
        places.places_m
    }

    /// z of a place, m; that of another one where it leaves it open.
    pub fn down_m(&self, place: &Place, open_z_m: f64) -> f64 {
        place.down_m(self.home_z_m).unwrap_or(open_z_m)
    }

    /// A leg of the present step from place to place, NED, m, with its corner.
    /// Without a turn to take over it begins with the present reference.
    pub fn leg(&self, way_m: [Vector3<f64>; 2], turn: Option<Turn>, situation: &Situation) -> Leg {
        let [from_m, _] = way_m;
        let radius_m = self.stops(&from_m).first().map_or(self.radius_m, |stop| stop.radius_m);
        let reference = &situation.outputs.setpoint;
        match turn {
            Some(turn) => {
                let leg = |limits: &Limits| {
                    let start = Start::settled(&turn.end(), limits, true);
                    let corner = self.corner_within(&from_m, &start, limits);
                    Leg::after(turn, way_m, radius_m, corner, self.limits)
                };
                // Limits that have been lowered hold from where the motion out of the turn can keep them.
                let within = |limits: &Limits| Some(leg(limits)).filter(|leg| leg.is_flyable(limits));
                match turn.limits(self.limits).least(within) {
                    Some((mut leg, true)) => {
                        leg.release_limits();
                        leg
                    }
                    Some((leg, false)) => leg,
                    None => leg(self.limits),
                }
            }
            None => {
                let start = Start::settled(reference, self.limits, is_at_rest(reference));
                Leg::begin(situation, way_m, radius_m, self.corner(&from_m, &start))
            }
        }
    }

    /// The corner at the end of the present step's leg, on a way that goes on from a start; `None` for a stop.
    pub fn corner(&self, from_m: &Vector3<f64>, start: &Start) -> Option<Corner> {
        self.corner_within(from_m, start, self.limits)
    }

    fn corner_within(&self, from_m: &Vector3<f64>, start: &Start, limits: &Limits) -> Option<Corner> {
        first_corner(start, &self.stops(from_m), limits, |blend| self.is_free(blend))
    }

    /// Whether the fence leaves room for a blend, and for a margin on its inner side.
    fn is_free(&self, blend: &Blend) -> bool {
        const PARTS: usize = 8;
        const MARGIN_M: f64 = 0.5;
        let Some(fence) = &self.fence else { return true };
        let point = |part: usize| {
            let place_m = blend.at(blend.duration_s * part as f64 / PARTS as f64).position_m;
            let inward = (place_m - blend.corner_m).try_normalize(1e-9).unwrap_or_default();
            place_m + inward * MARGIN_M
        };
        (0..PARTS).all(|part| {
            let (from_m, to_m) = (point(part), point(part + 1));
            fence.breach_on_way(&from_m, &to_m).is_none()
        })
    }

    /// The places from the present step on, as far as the vehicle goes from one to the next.
    fn stops(&self, from_m: &Vector3<f64>) -> Vec<Stop> {
        let mut jumps = self.jumps.clone();
        let (mut next, mut from_m) = (Some(self.current), *from_m);
        let mut yaw_rad = self.yaw_rad;
        let mut stops = Vec::new();
        while let Some(index) = next.filter(|_| stops.len() < AHEAD) {
            let Some(step) = self.program.navigate(index) else { break };
            let Some(position_m) = self.leg_end_m(&step, &from_m) else { break };
            let follows = jumps.next(self.program, index + 1).navigation;
            // A curve begins at rest.
            let curves = follows
                .and_then(|index| self.program.navigate(index))
                .is_some_and(|step| matches!(step, Navigate::Spline { .. }) || self.follows_ground(&step));
            let heading_rad = asked_heading_rad(&step);
            let turns = heading_rad
                .is_some_and(|heading_rad| self.turn_outlasts(heading_rad - yaw_rad, &(position_m - from_m)));
            let rests = curves || turns || self.faces_first || self.rests_at(index, &step);
            stops.push(Stop { position_m, radius_m: self.acceptance_radius_m(&step), rests });
            if rests {
                break;
            }
            next = follows;
            yaw_rad = heading_rad.or_else(|| bearing_rad(&from_m, &position_m)).unwrap_or(yaw_rad);
            from_m = position_m;
        }
        stops
    }

    /// Whether a turn, rad, that a waypoint asks for is not over before its way is, NED, m: then the vehicle rests there until it is.
    fn turn_outlasts(&self, turn_rad: f64, way_m: &Vector3<f64>) -> bool {
        let way_s = way_m.norm() / self.limits.speed_horizontal_m_s;
        self.waits_for.is_some_and(|heading| heading.outlasts(turn_rad, self.limits.yaw_rate_rad_s, way_s))
    }

    /// Whether the nose points to a place before it is flown to.
    pub fn faces_first(&self) -> bool {
        self.faces_first
    }

    /// Whether the vehicle comes to rest at a step.
    fn rests_at(&self, index: usize, step: &Navigate) -> bool {
        match step {
            Navigate::Waypoint(waypoint) => waypoint.hold_s > 0.0 || !self.program.continues_after(index),
            _ => true,
        }
    }

    fn acceptance_radius_m(&self, step: &Navigate) -> f64 {
        let own_m = match step {
            Navigate::Waypoint(waypoint) => waypoint.acceptance_radius_m,
            _ => None,
        };
        own_m.unwrap_or(self.radius_m)
    }
}

/// The heading that a waypoint asks for, rad.
fn asked_heading_rad(step: &Navigate) -> Option<f64> {
    match step {
        Navigate::Waypoint(waypoint) => waypoint.heading_rad,
        _ => None,
    }
}
