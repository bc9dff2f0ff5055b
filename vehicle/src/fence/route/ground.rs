//! Where a straight way may lead.

use super::super::polygon::Side;
use super::super::{Fence, Inclusions, Shape, Zone};

/// Share of the distance of the two ends to an area that ways keep from it, if they are nearer than the clearance.
const NEAR_SHARE: f64 = 0.9;
/// Share of the clearance that ways keep: the corners have all of it, and rounding must not block what leads along them.
const KEPT_SHARE: f64 = 0.99;

/// The areas of a fence, as the way between two places sees them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Ground {
    /// Areas to stay out of.
    pub obstacles: Vec<Obstacle>,
    /// Areas to stay in.
    pub inclusions: Vec<Zone>,
    /// How they combine.
    combined: Inclusions,
    /// Centre, north and east, and radius, m, of a circle to stay in beside that.
    within: Option<([f64; 2], f64)>,
    start: [f64; 2],
    goal: [f64; 2],
    /// Distance that ways keep from the border of the areas to stay in, m.
    border_margin_m: f64,
}

/// An area to stay out of.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Obstacle {
    /// The area.
    pub shape: Shape,
    /// South-west and north-east corners of what surrounds it.
    bounds_m: [[f64; 2]; 2],
    /// Distance that ways keep, m.
    margin_m: f64,
    /// Whether the way begins in it. It has to be left anyway.
    holds_start: bool,
}

impl Ground {
    /// Of a fence, for a way between two places, north and east, m, that keeps a clearance, m, where the places do.
    pub fn new(fence: &Fence, start: [f64; 2], goal: [f64; 2], clearance_m: f64) -> Self {
        let zones = fence.zones.map(|zones| zones.zones.as_slice()).unwrap_or_default();
        let (inclusions, exclusions): (Vec<&Zone>, Vec<&Zone>) =
            zones.iter().partition(|zone| zone.inclusion);
        let margin_m = |room_m: f64| (KEPT_SHARE * clearance_m).min(NEAR_SHARE * room_m);
        let obstacle = |zone: &Zone| {
            let shape = zone.shape.clone();
            let holds_start = shape.contains(start);
            let from_start_m = if holds_start { f64::INFINITY } else { shape.distance_m(start) };
            let margin_m = margin_m(from_start_m.min(shape.distance_m(goal)));
            Obstacle { bounds_m: shape.bounds_m(), margin_m, holds_start, shape }
        };
        let room_m = |place: [f64; 2]| {
            let around = inclusions.iter().filter(|zone| !zone.forbids(place));
            let room_m = around.map(|zone| zone.shape.distance_m(place));
            match fence.inclusions {
                Inclusions::Any => room_m.fold(0.0, f64::max),
                Inclusions::All => room_m.fold(f64::INFINITY, f64::min),
            }
        };
        let outside = fence.inclusions.forbid(inclusions.iter().map(|zone| zone.forbids(start)));
        let room_m = room_m(goal).min(if outside { f64::INFINITY } else { room_m(start) });
        let radius_m = Some(fence.radius_m).filter(|radius_m| *radius_m > 0.0);
        Self {
            obstacles: exclusions.into_iter().map(obstacle).collect(),
            border_margin_m: margin_m(room_m),
            inclusions: inclusions.into_iter().cloned().collect(),
            combined: fence.inclusions,
            within: radius_m.map(|radius_m| ([fence.home_m.x, fence.home_m.y], radius_m)),
            start,
            goal,
        }
    }

    /// The two ends.
    pub fn ends(&self) -> [[f64; 2]; 2] {
        [self.start, self.goal]
    }

    /// Whether a straight way stays in the areas to stay in. One that begins outside of them has to come in. `work` counts down by
    /// the sides looked at.
    pub fn stays_inside(&self, way: &Side, work: &mut u64) -> bool {
        if let Some(([x, y], radius_m)) = self.within
            && libm::hypot(way.1[0] - x, way.1[1] - y) > radius_m
        {
            return false;
        }
        if self.inclusions.is_empty() {
            return true;
        }
        if way.0 == self.start && self.is_outside(way.0) {
            return !self.is_outside(way.1);
        }
        let (dx, dy) = (way.1[0] - way.0[0], way.1[1] - way.0[1]);
        let length_m = libm::hypot(dx, dy).max(1e-9);
        // What leaves no room on one side crosses a parallel way there.
        [0.0, self.border_margin_m, -self.border_margin_m].into_iter().all(|aside_m| {
            let (x, y) = (-dy / length_m * aside_m, dx / length_m * aside_m);
            let parallel = ([way.0[0] + x, way.0[1] + y], [way.1[0] + x, way.1[1] + y]);
            self.is_covered(&parallel, work)
        })
    }

    /// Whether a place is where the areas to stay in do not allow it.
    fn is_outside(&self, place: [f64; 2]) -> bool {
        self.combined.forbid(self.inclusions.iter().map(|zone| zone.forbids(place)))
    }

    /// Whether each point of a way is where the areas to stay in allow it.
    fn is_covered(&self, way: &Side, work: &mut u64) -> bool {
        let mut parts_inside = |zone: &Zone, inside: &mut Vec<(f64, f64)>| {
            *work = work.saturating_sub(zone.shape.side_count());
            zone.shape.parts_inside(way, inside);
        };
        match self.combined {
            Inclusions::Any => {
                let mut inside = Vec::new();
                self.inclusions.iter().for_each(|zone| parts_inside(zone, &mut inside));
                covers(inside)
            }
            Inclusions::All => self.inclusions.iter().all(|zone| {
                let mut inside = Vec::new();
                parts_inside(zone, &mut inside);
                covers(inside)
            }),
        }
    }
}

/// Whether parts of a way, as shares of it from one to another, are all of it together.
fn covers(mut parts: Vec<(f64, f64)>) -> bool {
    /// Shares of the way.
    const ROUNDING: f64 = 1e-9;
    parts.sort_by(|one, other| one.0.total_cmp(&other.0));
    let mut covered = 0.0;
    for (from, to) in parts {
        if from > covered + ROUNDING {
            return false;
        }
        covered = to.max(covered);
    }
    covered >= 1.0 - ROUNDING
}

impl Obstacle {
    /// Whether it is in a straight way. `work` counts down by the sides looked at.
    pub fn blocks(&self, way: &Side, start: [f64; 2], work: &mut u64) -> bool {
        *work = work.saturating_sub(1);
        let apart = (0..2).any(|axis| {
            let (low, high) = (way.0[axis].min(way.1[axis]), way.0[axis].max(way.1[axis]));
            high < self.bounds_m[0][axis] - self.margin_m || low > self.bounds_m[1][axis] + self.margin_m
        });
        if apart || (self.holds_start && way.0 == start) {
            return false;
        }
        *work = work.saturating_sub(self.shape.side_count());
        self.shape.comes_within(way, self.margin_m)
    }
}
