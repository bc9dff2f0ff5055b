//! The way that a mission is planned to take, to be drawn and to be checked against the fence: its steps in the order of the plan,
//! each of which begins where the one before it ends. Jumps are not made, and corners are not cut.

use nalgebra::Vector3;

use super::super::ground_way::{GroundWay, leads_along_ground};
use super::super::spline::{Bend, CurvePlaces, curve_places_m};
use super::leg_end::{circle, leg_end_m, place_m};
use super::takeoff_height::{climb_z_m, takeoff_z_m};
use crate::plan::step::Navigate;
use crate::plan::{Place, Program};
use crate::surroundings::Terrain;

/// The way to the place of a step, NED, m.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedLeg {
    /// Number of the step.
    pub item: usize,
    /// Places between the end of the leg before and the place, on straight lines from one to the next.
    pub through_m: Vec<Vector3<f64>>,
    /// The place.
    pub place_m: Vector3<f64>,
}

/// What a mission begins with, and flies over.
#[derive(Clone, Copy, Debug)]
pub struct Beginning<'a> {
    /// What heights are above, NED, m.
    pub home_m: Vector3<f64>,
    /// Where the vehicle is, NED, m.
    pub from_m: Vector3<f64>,
    /// How high it climbs where its first step says nothing about that, m.
    pub takeoff_height_m: f64,
    /// The ground.
    pub terrain: &'a Terrain,
    /// Whether it stands on the ground, to climb before its first step; else it flies already.
    pub grounded: bool,
}

/// All legs.
pub fn planned_way(program: &Program, beginning: &Beginning) -> Vec<PlannedLeg> {
    let Beginning { from_m, grounded, .. } = *beginning;
    let mut planner = Planner { beginning: *beginning, at_m: from_m, grounded, legs: Vec::new() };
    let numbered = |item| Some((item, program.navigate(item)?));
    let mut steps = (program.first()..program.len()).filter_map(numbered).peekable();
    while let Some((mut item, step)) = steps.next() {
        let Navigate::Spline { place, mut hold_s } = step else {
            planner.fly(item, &step);
            continue;
        };
        // Up to the first place at which the vehicle rests.
        let mut curve = vec![(item, place)];
        while hold_s == 0.0
            && program.continues_after(item)
            && let Some((next, Navigate::Spline { place, hold_s: next_s })) =
                steps.next_if(|(_, step)| matches!(step, Navigate::Spline { .. }))
        {
            (item, hold_s) = (next, next_s);
            curve.push((item, place));
        }
        planner.fly_curve(&curve);
    }
    planner.legs
}

struct Planner<'a> {
    beginning: Beginning<'a>,
    /// Where the leg before ends.
    at_m: Vector3<f64>,
    /// Whether that is on the ground.
    grounded: bool,
    legs: Vec<PlannedLeg>,
}

impl Planner<'_> {
    fn end_m(&self, place: &Place, from_m: &Vector3<f64>) -> Vector3<f64> {
        place_m(place, from_m, self.beginning.home_m.z)
    }

    fn arrive(&mut self, item: usize, through_m: Vec<Vector3<f64>>, place_m: Vector3<f64>) {
        self.at_m = place_m;
        self.legs.push(PlannedLeg { item, through_m, place_m });
    }

    /// The climb that a step on the ground begins with which does not take off.
    fn climb(&mut self, step: &Navigate) -> Option<Vector3<f64>> {
        let Beginning { home_m, takeoff_height_m, .. } = self.beginning;
        let end_m = leg_end_m(step, &self.at_m, home_m.z);
        if std::mem::take(&mut self.grounded) {
            self.at_m.z = climb_z_m(end_m, home_m.z, takeoff_height_m);
            return Some(self.at_m);
        }
        None
    }

    fn fly(&mut self, item: usize, step: &Navigate) {
        match step {
            Navigate::Takeoff { place, travels } => return self.take_off(item, place, *travels),
            Navigate::Land { .. } if self.grounded => return,
            Navigate::ReturnToLaunch | Navigate::Delay(_) => return,
            _ => {}
        }
        let mut through_m: Vec<_> = self.climb(step).into_iter().collect();
        let Beginning { home_m, terrain, .. } = self.beginning;
        let end_m = leg_end_m(step, &self.at_m, home_m.z).unwrap_or(self.at_m);
        if leads_along_ground(step, terrain) {
            through_m.extend(GroundWay::new(self.at_m, end_m).sketch_m(terrain));
        } else {
            through_m.push(end_m);
        }
        match step {
            Navigate::Land { .. } => {
                self.grounded = true;
                through_m.push(Vector3::new(end_m.x, end_m.y, terrain.z_below_m(&end_m)));
            }
            Navigate::LoiterToAltitude { place } => through_m.push(self.end_m(place, &end_m)),
            Navigate::LoiterTurns(turns) => through_m.extend(circle(turns, &self.at_m, home_m.z).sketch_m()),
            _ => {}
        }
        let end_m = through_m.pop().unwrap_or(end_m);
        self.arrive(item, through_m, end_m);
    }

    /// Up where it is, and then to the place; who is above already does not come down.
    fn take_off(&mut self, item: usize, place: &Place, travels: bool) {
        self.grounded = false;
        let Beginning { home_m, takeoff_height_m, .. } = self.beginning;
        let z_m = takeoff_z_m(place, home_m.z, takeoff_height_m);
        let above_m = Vector3::new(self.at_m.x, self.at_m.y, z_m.min(self.at_m.z));
        match place.horizontal_m.filter(|_| travels) {
            Some([x, y]) => self.arrive(item, vec![above_m], Vector3::new(x, y, above_m.z)),
            None => self.arrive(item, Vec::new(), above_m),
        }
    }

    fn fly_curve(&mut self, curve: &[(usize, Place)]) {
        let first = curve.first().map(|(_, place)| Navigate::Spline { place: *place, hold_s: 0.0 });
        let climb_m = first.and_then(|step| self.climb(&step));
        let begin = self.legs.len();
        let mut places = CurvePlaces::new(self.at_m);
        let mut items = Vec::with_capacity(curve.len());
        for (item, place) in curve {
            let end_m = self.end_m(place, &places.end_m());
            if places.turns_back(&end_m) {
                self.fly_piece(&places, &std::mem::take(&mut items));
                places = CurvePlaces::new(places.end_m());
            }
            items.push((*item, places.push(end_m)));
        }
        self.fly_piece(&places, &items);
        if let Some(first) = self.legs.get_mut(begin) {
            first.through_m.splice(0..0, climb_m);
        }
    }

    /// Along one curve; of its items some are where the one before is.
    fn fly_piece(&mut self, places: &CurvePlaces, items: &[(usize, bool)]) {
        let mut pieces_m = curve_places_m(places.from_m, &places.places_m, Bend::Wide);
        for (item, goes_on) in items {
            let mut through_m = goes_on.then(|| pieces_m.next()).flatten().unwrap_or_default();
            let end_m = through_m.pop().unwrap_or(self.at_m);
            self.arrive(*item, through_m, end_m);
        }
    }
}
