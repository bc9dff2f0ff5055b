//! The way that a mission is planned to take, to be drawn: its steps in the order of the plan, each of which begins where the one before it
//! ends. Jumps are not made, and corners are not cut.

use nalgebra::Vector3;

use super::super::ground_way::{GroundWay, leads_along_ground};
use super::super::spline::{Bend, curve_places_m};
use super::takeoff_height::takeoff_z_m;
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
    /// Where the vehicle takes off, NED, m.
    pub home_m: Vector3<f64>,
    /// How high it climbs where its first step says nothing about that, m.
    pub takeoff_height_m: f64,
    /// The ground.
    pub terrain: &'a Terrain,
}

/// All legs, from home on.
pub fn planned_way(program: &Program, beginning: &Beginning) -> Vec<PlannedLeg> {
    let mut planner = Planner { beginning: *beginning, at_m: beginning.home_m, legs: Vec::new() };
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
    legs: Vec<PlannedLeg>,
}

impl Planner<'_> {
    fn end_m(&self, place: &Place, from_m: &Vector3<f64>) -> Vector3<f64> {
        let [x, y] = place.horizontal_m.unwrap_or([from_m.x, from_m.y]);
        Vector3::new(x, y, place.down_m(self.beginning.home_m.z).unwrap_or(from_m.z))
    }

    fn arrive(&mut self, item: usize, through_m: Vec<Vector3<f64>>, place_m: Vector3<f64>) {
        self.at_m = place_m;
        self.legs.push(PlannedLeg { item, through_m, place_m });
    }

    /// The climb that a mission begins with which does not take off: to the height of its first place, and at least to that of a takeoff.
    fn climb_m(&self, first_z_m: f64) -> Option<Vector3<f64>> {
        let Beginning { home_m, takeoff_height_m, .. } = self.beginning;
        let z_m = first_z_m.min(home_m.z - takeoff_height_m);
        self.legs.is_empty().then(|| Vector3::new(home_m.x, home_m.y, z_m))
    }

    fn fly(&mut self, item: usize, step: &Navigate) {
        let Some(place) = step.place() else { return };
        let end_m = self.end_m(place, &self.at_m);
        if let Navigate::Takeoff { place, travels } = step {
            return self.take_off(item, place, *travels);
        }
        let climb_m = self.climb_m(end_m.z);
        let from_m = climb_m.unwrap_or(self.at_m);
        let terrain = self.beginning.terrain;
        let at_height_m = |z_m: f64| Vector3::new(end_m.x, end_m.y, z_m);
        let (between_m, end_m) = match step {
            Navigate::Land { .. } => (vec![at_height_m(from_m.z)], at_height_m(terrain.z_below_m(&end_m))),
            Navigate::LoiterToAltitude { .. } => (vec![at_height_m(from_m.z)], end_m),
            _ if leads_along_ground(step, terrain) => {
                let mut places_m: Vec<_> = GroundWay::new(from_m, end_m).places_m(&from_m, terrain).collect();
                places_m.pop();
                (places_m, end_m)
            }
            _ => (Vec::new(), end_m),
        };
        self.arrive(item, climb_m.into_iter().chain(between_m).collect(), end_m);
    }

    /// Up where it is, and then to the place; who is above already does not come down.
    fn take_off(&mut self, item: usize, place: &Place, travels: bool) {
        let Beginning { home_m, takeoff_height_m, .. } = self.beginning;
        let z_m = takeoff_z_m(place, home_m.z, takeoff_height_m);
        let above_m = Vector3::new(self.at_m.x, self.at_m.y, z_m.min(self.at_m.z));
        match place.horizontal_m.filter(|_| travels) {
            Some([x, y]) => self.arrive(item, vec![above_m], Vector3::new(x, y, above_m.z)),
            None => self.arrive(item, Vec::new(), above_m),
        }
    }

    fn fly_curve(&mut self, curve: &[(usize, Place)]) {
        let mut at_m = self.at_m;
        let mut ends_m = Vec::with_capacity(curve.len());
        for (_, place) in curve {
            at_m = self.end_m(place, &at_m);
            ends_m.push(at_m);
        }
        let climb_m = ends_m.first().and_then(|first_m| self.climb_m(first_m.z));
        let pieces_m = curve_places_m(climb_m.unwrap_or(self.at_m), &ends_m, Bend::Wide);
        for (((item, _), end_m), mut through_m) in curve.iter().zip(&ends_m).zip(pieces_m) {
            through_m.pop();
            through_m.splice(0..0, climb_m.filter(|_| self.legs.is_empty()));
            self.arrive(*item, through_m, *end_m);
        }
    }
}
