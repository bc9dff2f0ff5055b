//! A way that follows the ground: straight on the map, at a height above the ground that changes evenly from its beginning to its end.
//!
//! ```text
//!  z(s) = ground(s) − h(0) (1 − s/L) − h(L) s/L,   0 ≤ s ≤ L
//! ```
//!
//! It is flown along a curve through places that lie densely on it.

use libm::{ceil, round};
use nalgebra::Vector3;

use super::heading_policy::{HeadingPolicy, Purpose};
use super::set_point::{PositionSetPoint, YawTarget};
use super::situation::Situation;
use super::spline::{Bend, Onward, Spline};
use crate::plan::Place;
use crate::plan::step::Navigate;
use crate::surroundings::Terrain;

/// Largest distance between the places, on the map, m.
const SPACING_M: f64 = 4.0;
/// So many places of a way are drawn and checked at most: 4 m apart up to 8 km.
const SKETCHED: f64 = 2000.0;
/// So many places are looked ahead: far enough to brake within.
pub const PLACES_AHEAD: usize = 24;

/// The way from a place to another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundWay {
    from_m: Vector3<f64>,
    to_m: Vector3<f64>,
}

impl GroundWay {
    /// The way between two places, NED, m.
    pub fn new(from_m: Vector3<f64>, to_m: Vector3<f64>) -> Self {
        Self { from_m, to_m }
    }

    /// Where it begins and where it ends, NED, m.
    pub fn ends_m(&self) -> [Vector3<f64>; 2] {
        [self.from_m, self.to_m]
    }

    /// Where it ends, NED, m.
    pub fn end_m(&self) -> Vector3<f64> {
        self.to_m
    }

    /// Its direction on the map, rad, if it has one.
    pub fn bearing_rad(&self) -> Option<f64> {
        let way = self.to_m - self.from_m;
        (way.xy().norm() > 0.0).then(|| libm::atan2(way.y, way.x))
    }

    /// The places behind one of them, NED, m, up to its end.
    pub fn places_m(&self, here_m: &Vector3<f64>, terrain: &Terrain) -> impl Iterator<Item = Vector3<f64>> {
        let way = (self.to_m - self.from_m).xy();
        let parts = self.parts();
        let flown = way.dot(&(here_m - self.from_m).xy()) / way.norm_squared();
        // A way that leads straight up or down has one part.
        let flown = if flown.is_finite() { round(flown * parts).clamp(0.0, parts - 1.0) } else { 0.0 };
        self.ends_of_parts_m(flown as usize, parts, terrain)
    }

    /// The next of them, as far as is looked ahead.
    pub fn places_ahead_m(&self, here_m: &Vector3<f64>, situation: &Situation) -> Vec<Vector3<f64>> {
        self.places_m(here_m, situation.terrain).take(PLACES_AHEAD).collect()
    }

    /// The next piece of its curve: onward in full motion, or from rest. `None` at its end.
    pub fn piece(
        &self,
        here_m: Vector3<f64>,
        onward: Option<Onward>,
        situation: &Situation,
    ) -> Option<Spline> {
        let places_m = self.places_ahead_m(&here_m, situation);
        Spline::new(here_m, onward, &places_m, Bend::Close, situation.limits())
    }

    /// Places on all of it, NED, m, up to its end; on a long way they lie farther apart.
    pub fn sketch_m(&self, terrain: &Terrain) -> impl Iterator<Item = Vector3<f64>> {
        self.ends_of_parts_m(0, self.parts().min(SKETCHED), terrain)
    }

    fn parts(&self) -> f64 {
        ceil((self.to_m - self.from_m).xy().norm() / SPACING_M).max(1.0)
    }

    fn ends_of_parts_m(
        &self,
        flown: usize,
        parts: f64,
        terrain: &Terrain,
    ) -> impl Iterator<Item = Vector3<f64>> {
        let heights_m = [self.from_m, self.to_m].map(|place_m| terrain.z_below_m(&place_m) - place_m.z);
        (flown + 1..=parts as usize).map(move |part| {
            let share = part as f64 / parts;
            if share == 1.0 {
                return self.to_m;
            }
            let mut place_m = self.from_m + (self.to_m - self.from_m) * share;
            place_m.z = terrain.z_below_m(&place_m) - heights_m[0] * (1.0 - share) - heights_m[1] * share;
            place_m
        })
    }
}

/// Whether the way to a step's place follows the ground.
pub fn leads_along_ground(step: &Navigate, terrain: &Terrain) -> bool {
    let place = match step {
        Navigate::Waypoint(_)
        | Navigate::Loiter { .. }
        | Navigate::LoiterTime { .. }
        | Navigate::LoiterTurns(_)
        | Navigate::PlacePayload { .. } => step.place(),
        _ => None,
    };
    !terrain.is_flat() && place.is_some_and(Place::is_above_ground)
}

/// A set-point on a curve, with the heading that the parameter asks for.
pub fn headed(
    set_point: PositionSetPoint,
    purpose: Purpose,
    way_rad: f64,
    situation: &Situation,
) -> PositionSetPoint {
    let yaw = match HeadingPolicy::of(situation).heading_rad(purpose, way_rad, situation) {
        Some(heading_rad) if heading_rad == way_rad => set_point.yaw,
        Some(heading_rad) => YawTarget::Angle(heading_rad),
        None => YawTarget::Hold,
    };
    PositionSetPoint { yaw, ..set_point }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::GroundWay;
    use crate::surroundings::{Hill, Relief, Terrain};

    #[test]
    fn heights_above_the_ground_change_evenly() {
        let hill = Hill { centre_m: [50.0, 0.0], radius_m: 40.0, top_m: 5.0, height_m: 20.0 };
        let terrain = Terrain::new(Relief { grid: None, hills: vec![hill] });
        let way = GroundWay::new(Vector3::new(0.0, 0.0, -10.0), Vector3::new(100.0, 0.0, -15.0));
        let places_m: Vec<_> = way.places_m(&Vector3::new(0.0, 0.0, -10.0), &terrain).collect();
        assert_eq!((places_m.len(), places_m.last().copied()), (25, Some(way.end_m())));
        for place_m in &places_m {
            let above_m = terrain.z_below_m(place_m) - place_m.z;
            assert!((above_m - 10.0 - 0.05 * place_m.x).abs() < 1e-9, "{place_m}");
        }
        assert!(way.places_m(&places_m[9], &terrain).eq(places_m[10..].iter().copied()));
        assert_eq!(way.places_m(&way.end_m(), &terrain).collect::<Vec<_>>(), [way.end_m()]);
    }

    /// A plan may name a place on the other side of the Earth.
    #[test]
    fn the_sketch_of_a_way_has_no_more_places_than_can_be_drawn() {
        let terrain = Terrain::default();
        let sketch_m = |length_m| {
            let way = GroundWay::new(Vector3::zeros(), Vector3::new(length_m, 0.0, -9.0));
            way.sketch_m(&terrain).collect::<Vec<_>>()
        };
        assert_eq!(sketch_m(100.0).len(), 25);
        let far_m = sketch_m(2e7);
        assert_eq!((far_m.len(), far_m.last().copied()), (2000, Some(Vector3::new(2e7, 0.0, -9.0))));
    }

    #[test]
    fn a_way_straight_up_has_one_place() {
        let way = GroundWay::new(Vector3::new(3.0, 4.0, -1.0), Vector3::new(3.0, 4.0, -9.0));
        let places_m: Vec<_> = way.places_m(&Vector3::new(3.0, 4.0, -1.0), &Terrain::default()).collect();
        assert_eq!((places_m, way.bearing_rad()), (vec![way.end_m()], None));
    }
}
