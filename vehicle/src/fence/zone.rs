//! One area to stay in or out of.

use super::polygon::{Polygon, Side};

/// An area.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// Around a point.
    Circle {
        /// North and east, m.
        centre_m: [f64; 2],
        /// Radius, m.
        radius_m: f64,
    },
    /// Within corners.
    Polygon(Polygon),
}

/// An area with its meaning.
#[derive(Clone, Debug, PartialEq)]
pub struct Zone {
    /// The area.
    pub shape: Shape,
    /// Whether to stay in it; else out of it.
    pub inclusion: bool,
}

impl Shape {
    /// Whether a point is inside.
    pub fn contains(&self, point: [f64; 2]) -> bool {
        match self {
            Self::Circle { centre_m, radius_m } => distance(*centre_m, point) <= *radius_m,
            Self::Polygon(polygon) => polygon.contains(point),
        }
    }

    /// Distance of a point to the border, m.
    pub fn distance_m(&self, point: [f64; 2]) -> f64 {
        match self {
            Self::Circle { centre_m, radius_m } => (distance(*centre_m, point) - radius_m).abs(),
            Self::Polygon(polygon) => polygon.distance_m(point),
        }
    }

    /// Whether the straight way between two points comes into the area, or as near as a margin, m.
    pub(super) fn comes_within(&self, way: &Side, margin_m: f64) -> bool {
        match self {
            Self::Circle { centre_m, radius_m } => nearest_on(way, *centre_m) <= radius_m + margin_m,
            Self::Polygon(polygon) => polygon.contains(way.0) || polygon.comes_within(way, margin_m),
        }
    }

    /// The parts of a straight way that are inside, as shares of it from one to another, are added.
    pub(super) fn parts_inside(&self, way: &Side, parts: &mut Vec<(f64, f64)>) {
        match self {
            Self::Circle { centre_m: [x, y], radius_m } => {
                let (along, offset) =
                    ([way.1[0] - way.0[0], way.1[1] - way.0[1]], [way.0[0] - x, way.0[1] - y]);
                // |offset + s along|² = r²
                let a = (along[0] * along[0] + along[1] * along[1]).max(1e-12);
                let b = along[0] * offset[0] + along[1] * offset[1];
                let c = offset[0] * offset[0] + offset[1] * offset[1] - radius_m * radius_m;
                let root = libm::sqrt(b * b - a * c);
                // No root: it passes by.
                if root.is_finite() {
                    parts.push(((-b - root) / a, (-b + root) / a));
                }
            }
            Self::Polygon(polygon) => polygon.parts_inside(way, parts),
        }
    }

    /// How many sides have to be looked at.
    pub(super) fn side_count(&self) -> u64 {
        match self {
            Self::Circle { .. } => 1,
            Self::Polygon(polygon) => polygon.corners().len() as u64,
        }
    }

    /// South-west and north-east corners of what surrounds it, north and east, m.
    pub(super) fn bounds_m(&self) -> [[f64; 2]; 2] {
        match self {
            Self::Circle { centre_m: [x, y], radius_m } => {
                [[x - radius_m, y - radius_m], [x + radius_m, y + radius_m]]
            }
            Self::Polygon(polygon) => polygon.bounds_m(),
        }
    }

    /// Whether the straight way between two points comes into the area.
    pub fn is_entered_by(&self, way: &Side) -> bool {
        match self {
            Self::Circle { centre_m, radius_m } => nearest_on(way, *centre_m) <= *radius_m,
            Self::Polygon(polygon) => polygon.contains(way.0) || polygon.is_met_by(way),
        }
    }
}

impl Zone {
    /// Whether a point is where it must not be.
    pub fn forbids(&self, point: [f64; 2]) -> bool {
        self.shape.contains(point) != self.inclusion
    }

    /// How far a point is on the right side of the border, m; negative: on the wrong one.
    pub fn room_m(&self, point: [f64; 2]) -> f64 {
        let distance_m = self.shape.distance_m(point);
        if self.forbids(point) { -distance_m } else { distance_m }
    }
}

fn distance([ax, ay]: [f64; 2], [bx, by]: [f64; 2]) -> f64 {
    libm::hypot(ax - bx, ay - by)
}

/// Least distance of a point to a way.
fn nearest_on((a, b): &Side, point: [f64; 2]) -> f64 {
    let (along, offset) = ([b[0] - a[0], b[1] - a[1]], [point[0] - a[0], point[1] - a[1]]);
    let length_squared = along[0] * along[0] + along[1] * along[1];
    let share = ((offset[0] * along[0] + offset[1] * along[1]) / length_squared.max(1e-12)).clamp(0.0, 1.0);
    let apart = [offset[0] - share * along[0], offset[1] - share * along[1]];
    libm::sqrt(apart[0] * apart[0] + apart[1] * apart[1])
}
