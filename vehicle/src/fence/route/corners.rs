//! Where a way around areas can bend.

use core::f64::consts::{FRAC_PI_2, PI, TAU};

use super::super::{Polygon, Shape};
use super::ground::Ground;

/// Corners of the polygon that stands for a circle on the way around it.
const CIRCLE_CORNERS: usize = 16;
/// Directions in which a corner is looked for beside a place where two borders cross.
const DIRECTIONS: usize = 8;
/// More crossings of borders than this are not looked at.
const MOST_CROSSINGS: usize = 200;

/// A place where a way can bend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Corner {
    /// North and east, m.
    pub place: [f64; 2],
    /// Its neighbours on the way around a circle.
    pub ring: Option<Ring>,
}

/// What surrounds a circle: a way touches it at a corner, or leads past.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ring {
    centre: [f64; 2],
    /// Distance of the corners from the centre, m.
    far_m: f64,
    before: [f64; 2],
    after: [f64; 2],
}

impl Corner {
    /// A place by itself.
    pub fn alone(place: [f64; 2]) -> Self {
        Self { place, ring: None }
    }

    /// Whether the straight way to or from another place can be part of a shortest way: it touches the ring, with both neighbours
    /// on one side.
    pub fn is_touched_from(&self, [x, y]: [f64; 2]) -> bool {
        let Some(Ring { centre, far_m, before, after }) = &self.ring else { return true };
        // From within the ring nothing touches it.
        let within = libm::hypot(x - centre[0], y - centre[1]) < far_m * (1.0 - 1e-9);
        let along = [self.place[0] - x, self.place[1] - y];
        let side = |[bx, by]: [f64; 2]| along[0] * (by - y) - along[1] * (bx - x);
        let rounding = 1e-9 * (along[0] * along[0] + along[1] * along[1] + far_m * far_m);
        let (one, other) = (side(*before), side(*after));
        within || (one > -rounding && other > -rounding) || (one < rounding && other < rounding)
    }
}

/// The corners around an area to stay out of, a clearance, m, off.
pub(super) fn around(shape: &Shape, clearance_m: f64) -> Vec<Corner> {
    match shape {
        Shape::Circle { centre_m, radius_m } => around_circle(*centre_m, radius_m + clearance_m),
        Shape::Polygon(polygon) => around_polygon(polygon, clearance_m, false),
    }
}

/// The corners of the areas to stay in, and those where their borders cross: a clearance, m, inside.
pub(super) fn inside(ground: &Ground, clearance_m: f64) -> Vec<Corner> {
    let mut corners = Vec::new();
    for zone in &ground.inclusions {
        if let Shape::Polygon(polygon) = &zone.shape {
            corners.extend(around_polygon(polygon, clearance_m, true));
        }
    }
    let outlines: Vec<Vec<[f64; 2]>> = ground.inclusions.iter().map(|zone| outline(&zone.shape)).collect();
    let mut crossings = Vec::new();
    for (number, one) in outlines.iter().enumerate() {
        for other in outlines.iter().skip(number + 1) {
            cross(one, other, &mut crossings);
        }
    }
    for [x, y] in crossings {
        corners.extend((0..DIRECTIONS).map(|index| {
            let angle = TAU * index as f64 / DIRECTIONS as f64;
            Corner::alone([x + clearance_m * libm::cos(angle), y + clearance_m * libm::sin(angle)])
        }));
    }
    corners
}

/// The sides between the corners touch the circle.
fn around_circle(centre: [f64; 2], radius_m: f64) -> Vec<Corner> {
    let step = TAU / CIRCLE_CORNERS as f64;
    let far_m = radius_m / libm::cos(step / 2.0);
    let point = |index: usize| {
        let angle = index as f64 * step;
        [centre[0] + far_m * libm::cos(angle), centre[1] + far_m * libm::sin(angle)]
    };
    let corner = |index: usize| {
        let (before, after) = (point(index + CIRCLE_CORNERS - 1), point(index + 1));
        Corner { place: point(index), ring: Some(Ring { centre, far_m, before, after }) }
    };
    (0..CIRCLE_CORNERS).map(corner).collect()
}

/// Corners off a polygon, outside or inside: those around which a way can bend. Sharp ones have two.
fn around_polygon(polygon: &Polygon, clearance_m: f64, inside: bool) -> Vec<Corner> {
    let corners = polygon.corners();
    let count = corners.len();
    let corner = |index: usize| corners.get(index % count).copied().unwrap_or_default();
    // The free side is on the right of the sides, seen from above.
    let outward = if (polygon.signed_area_m2() > 0.0) == inside { 1.0 } else { -1.0 };
    let direction = |from: [f64; 2], to: [f64; 2]| libm::atan2(to[1] - from[1], to[0] - from[0]);
    let mut places = Vec::new();
    for index in 0..count {
        let (before, here, after) = (corner(index + count - 1), corner(index), corner(index + 1));
        let (come, go) = (direction(before, here), direction(here, after));
        let turn = libm::remainder(go - come, TAU);
        // A way bends around a corner that turns away from its side.
        if turn * outward >= 0.0 {
            continue;
        }
        let parts = libm::ceil(libm::fabs(turn) / FRAC_PI_2).max(1.0);
        let far_m = clearance_m / libm::cos(turn / parts / 2.0);
        for part in 0..parts as usize {
            let angle = come + outward * FRAC_PI_2 + turn * (part as f64 + 0.5) / parts;
            let place = [here[0] + far_m * libm::cos(angle), here[1] + far_m * libm::sin(angle)];
            places.push(Corner::alone(place));
        }
    }
    places
}

/// The border of an area as corners.
fn outline(shape: &Shape) -> Vec<[f64; 2]> {
    const SIDES: usize = 32;
    match shape {
        Shape::Circle { centre_m: [x, y], radius_m } => {
            let point = |index: usize| {
                let angle = 2.0 * PI * index as f64 / SIDES as f64;
                [x + radius_m * libm::cos(angle), y + radius_m * libm::sin(angle)]
            };
            (0..SIDES).map(point).collect()
        }
        Shape::Polygon(polygon) => polygon.corners().to_vec(),
    }
}

/// Where two borders cross.
fn cross(one: &[[f64; 2]], other: &[[f64; 2]], crossings: &mut Vec<[f64; 2]>) {
    let sides = |corners: &[[f64; 2]]| -> Vec<([f64; 2], [f64; 2])> {
        corners.iter().copied().zip(corners.iter().copied().cycle().skip(1)).collect()
    };
    let others = sides(other);
    for (a, b) in sides(one) {
        for (c, d) in &others {
            if crossings.len() >= MOST_CROSSINGS {
                return;
            }
            let (u, v) = ([b[0] - a[0], b[1] - a[1]], [d[0] - c[0], d[1] - c[1]]);
            let apart = [c[0] - a[0], c[1] - a[1]];
            let area = u[0] * v[1] - u[1] * v[0];
            let share = (apart[0] * v[1] - apart[1] * v[0]) / area;
            let other_share = (apart[0] * u[1] - apart[1] * u[0]) / area;
            if (0.0..=1.0).contains(&share) && (0.0..=1.0).contains(&other_share) {
                crossings.push([a[0] + share * u[0], a[1] + share * u[1]]);
            }
        }
    }
}
