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
}

fn distance([ax, ay]: [f64; 2], [bx, by]: [f64; 2]) -> f64 {
    libm::hypot(ax - bx, ay - by)
}

/// Least distance of a point to a way.
fn nearest_on((a, b): &Side, point: [f64; 2]) -> f64 {
    let (along, offset) = ([b[0] - a[0], b[1] - a[1]], [point[0] - a[0], point[1] - a[1]]);
    let length_squared = along[0] * along[0] + along[1] * along[1];
    let share = ((offset[0] * along[0] + offset[1] * along[1]) / length_squared.max(1e-12)).clamp(0.0, 1.0);
    libm::hypot(offset[0] - share * along[0], offset[1] - share * along[1])
}
