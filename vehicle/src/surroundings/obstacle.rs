//! Boxes and cylinders that stand on the ground or above it.

use libm::{cos, sin, sqrt};
use nalgebra::{Rotation2, Vector2, Vector3};
use serde::{Deserialize, Serialize};

/// Something that must not be touched.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Obstacle {
    /// What people call it.
    pub name: String,
    /// What it looks like.
    pub shape: Shape,
    /// Its lower end above the ground, m.
    pub bottom_m: f64,
    /// Its upper end above the ground, m.
    pub top_m: f64,
}

/// The ground plan of an obstacle, in the local frame: north and east.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Shape {
    /// A box.
    Box {
        /// Its middle, m.
        centre_m: [f64; 2],
        /// Its length along its heading and its width across, m.
        size_m: [f64; 2],
        /// Its heading, rad.
        heading_rad: f64,
    },
    /// A cylinder that stands upright.
    Cylinder {
        /// Its middle, m.
        centre_m: [f64; 2],
        /// Its radius, m.
        radius_m: f64,
    },
}

impl Obstacle {
    /// A wall between two places, north and east, m: a box with a thickness, m, from the ground up.
    pub fn wall(name: String, from_m: [f64; 2], to_m: [f64; 2], thickness_m: f64, height_m: f64) -> Self {
        let (from, to) = (Vector2::from(from_m), Vector2::from(to_m));
        let way = to - from;
        let shape = Shape::Box {
            centre_m: ((from + to) / 2.0).into(),
            size_m: [way.norm(), thickness_m],
            heading_rad: libm::atan2(way.y, way.x),
        };
        Self { name, shape, bottom_m: 0.0, top_m: height_m }
    }

    /// Distance of a place, NED, m, from its surface; zero within.
    pub fn distance_m(&self, place_m: &Vector3<f64>) -> f64 {
        let height_m = -place_m.z;
        let above = (height_m - self.top_m).max(self.base_m() - height_m).max(0.0);
        let [beside, behind] = match self.shape {
            Shape::Box { centre_m, size_m, heading_rad } => {
                let own = Rotation2::new(-heading_rad) * (place_m.xy() - Vector2::from(centre_m));
                [(own.x.abs() - size_m[0] / 2.0).max(0.0), (own.y.abs() - size_m[1] / 2.0).max(0.0)]
            }
            Shape::Cylinder { centre_m, radius_m } => {
                [((place_m.xy() - Vector2::from(centre_m)).norm() - radius_m).max(0.0), 0.0]
            }
        };
        sqrt(above * above + beside * beside + behind * behind)
    }

    /// Where it begins, m above the ground: what stands on the ground is rooted in it, as feet sink into it by millimetres.
    fn base_m(&self) -> f64 {
        if self.bottom_m > 0.0 { self.bottom_m } else { -ROOTS_M }
    }

    /// How far a ray from a place, NED, m, goes in a direction of length one before it meets the surface, m.
    pub fn along_m(&self, place_m: &Vector3<f64>, direction: &Vector3<f64>) -> Option<f64> {
        let up = slab(-place_m.z - self.base_m(), -direction.z, self.top_m - self.base_m())?;
        let plan = match self.shape {
            Shape::Box { centre_m, size_m, heading_rad } => {
                let turn = Rotation2::new(-heading_rad);
                let own = turn * (place_m.xy() - Vector2::from(centre_m)) + Vector2::from(size_m) / 2.0;
                let ahead = turn * direction.xy();
                both(slab(own.x, ahead.x, size_m[0])?, slab(own.y, ahead.y, size_m[1])?)?
            }
            Shape::Cylinder { centre_m, radius_m } => {
                circle(&(place_m.xy() - Vector2::from(centre_m)), &direction.xy(), radius_m)?
            }
        };
        let (enters_m, leaves_m) = both(up, plan)?;
        (leaves_m >= 0.0).then_some(enters_m.max(0.0))
    }
}

/// How deep obstacles that stand on the ground reach into it, m.
const ROOTS_M: f64 = 10.0;

/// Where a line from `at` with a slope is between zero and a width: from and to.
fn slab(at: f64, slope: f64, width: f64) -> Option<(f64, f64)> {
    if slope.abs() < 1e-12 {
        return (0.0..=width).contains(&at).then_some((f64::NEG_INFINITY, f64::INFINITY));
    }
    let (one, other) = (-at / slope, (width - at) / slope);
    Some((one.min(other), one.max(other)))
}

fn circle(from: &Vector2<f64>, direction: &Vector2<f64>, radius: f64) -> Option<(f64, f64)> {
    let (a, b, c) = (direction.norm_squared(), from.dot(direction), from.norm_squared() - radius * radius);
    if a < 1e-12 {
        return (c <= 0.0).then_some((f64::NEG_INFINITY, f64::INFINITY));
    }
    let root = sqrt(Some(b * b - a * c).filter(|square| *square >= 0.0)?);
    Some(((-b - root) / a, (-b + root) / a))
}

fn both(one: (f64, f64), other: (f64, f64)) -> Option<(f64, f64)> {
    let (from, to) = (one.0.max(other.0), one.1.min(other.1));
    (from <= to).then_some((from, to))
}

/// A direction over the ground, NED, of a heading, rad.
pub(super) fn ahead(heading_rad: f64) -> Vector3<f64> {
    Vector3::new(cos(heading_rad), sin(heading_rad), 0.0)
}

#[cfg(test)]
mod tests {
    use core::f64::consts::FRAC_PI_4;

    use nalgebra::Vector3;

    use super::{Obstacle, Shape, ahead};

    fn box_at(centre_m: [f64; 2], size_m: [f64; 2], heading_rad: f64) -> Obstacle {
        let shape = Shape::Box { centre_m, size_m, heading_rad };
        Obstacle { name: String::new(), shape, bottom_m: 0.0, top_m: 5.0 }
    }

    #[test]
    fn distances_are_those_of_solid_geometry() {
        let house = box_at([10.0, 0.0], [4.0, 2.0], 0.0);
        for (place, expected) in [
            ([0.0, 0.0, -2.0], 8.0),
            ([10.0, 4.0, -2.0], 3.0),
            ([10.0, 0.0, -9.0], 4.0),
            ([5.0, 5.0, -2.0], 5.0),
            ([10.0, 0.0, -1.0], 0.0),
        ] {
            assert!((house.distance_m(&Vector3::from(place)) - expected).abs() < 1e-12, "{place:?}");
        }
        let turned = box_at([10.0, 0.0], [2.0, 2.0], FRAC_PI_4);
        assert!((turned.distance_m(&Vector3::new(0.0, 0.0, -1.0)) - (10.0 - 2.0_f64.sqrt())).abs() < 1e-12);
    }

    /// A ray ends where the distance becomes zero: an oracle that does not solve the same equations.
    #[test]
    fn rays_end_on_the_surface() {
        let pole = Obstacle {
            name: String::new(),
            shape: Shape::Cylinder { centre_m: [6.0, 8.0], radius_m: 1.5 },
            bottom_m: 1.0,
            top_m: 4.0,
        };
        let wall = Obstacle::wall(String::new(), [10.0, -5.0], [15.0, 5.0], 0.4, 6.0);
        let mut hits = 0;
        for obstacle in [&pole, &wall, &box_at([-7.0, 3.0], [4.0, 2.0], 0.3)] {
            for degree in 0..360 {
                for slope in [-0.4, 0.0, 0.3] {
                    let direction =
                        (ahead(f64::from(degree).to_radians()) + Vector3::new(0.0, 0.0, slope)).normalize();
                    let from = Vector3::new(0.0, 0.0, -3.0);
                    let Some(along_m) = obstacle.along_m(&from, &direction) else { continue };
                    hits += 1;
                    let end = from + direction * along_m;
                    assert!(obstacle.distance_m(&end) < 1e-9, "{degree}");
                    assert!(
                        obstacle.distance_m(&(end - direction * 1e-3)) > 0.0,
                        "{degree}: it is met earlier"
                    );
                }
            }
        }
        assert!(hits > 60, "{hits}");
        assert_eq!(pole.along_m(&Vector3::new(0.0, 0.0, -9.0), &ahead(0.927)), None, "above it");
    }
}
