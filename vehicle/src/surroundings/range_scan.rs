//! Distances all around, as a turning lidar measures them or a companion computer tells them.

use core::f64::consts::TAU;

use nalgebra::{Vector2, Vector3};

use super::Obstacle;
use super::obstacle::ahead;

/// Sectors of a scan.
pub const SECTORS: usize = 72;
/// Width of a sector, rad.
pub const SECTOR_RAD: f64 = TAU / SECTORS as f64;
/// Nearest that our lidar and our rangefinder measure, m.
pub const NEAREST_RANGE_M: f64 = 0.2;
/// Farthest that they measure, m.
pub const FARTHEST_RANGE_M: f64 = 40.0;
/// Rays in a sector: what is thinner than a degree may hide between them.
const RAYS: usize = 5;

/// What is known of a sector.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum Reading {
    /// Nothing.
    #[default]
    Unknown,
    /// Nothing is there, as far as the instrument sees.
    Free,
    /// The nearest thing is this far away, m.
    At(f64),
}

impl Reading {
    /// What two of the same sector tell together: the nearer thing counts.
    pub fn nearer(self, other: Self) -> Self {
        match (self, other) {
            (Self::At(one_m), Self::At(other_m)) => Self::At(one_m.min(other_m)),
            (Self::At(_), _) | (Self::Free, Self::Unknown | Self::Free) => self,
            _ => other,
        }
    }
}

/// One turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RangeScan {
    /// When, µs.
    pub time_us: u64,
    /// Where from, NED, m.
    pub position_m: Vector3<f64>,
    /// The heading of the middle of the first sector, rad.
    pub heading_rad: f64,
    /// The sectors, clockwise seen from above.
    pub sectors: [Reading; SECTORS],
}

impl RangeScan {
    /// A turn of our lidar, in the plane of the vehicle's height. `seen_from_m` is where it truly is, NED, m.
    pub fn of_obstacles(
        obstacles: &[Obstacle],
        seen_from_m: &Vector3<f64>,
        time_us: u64,
        position_m: Vector3<f64>,
        heading_rad: f64,
    ) -> Self {
        let ray_m = |heading_rad: f64| {
            let direction = ahead(heading_rad);
            obstacles
                .iter()
                .filter_map(|obstacle| obstacle.along_m(seen_from_m, &direction))
                .fold(f64::INFINITY, f64::min)
        };
        let sectors = core::array::from_fn(|sector| {
            let rays = (0..RAYS).map(|ray| {
                let part = (ray as f64 + 0.5) / RAYS as f64 - 0.5;
                ray_m(heading_rad + (sector as f64 + part) * SECTOR_RAD)
            });
            match rays.fold(f64::INFINITY, f64::min) {
                range_m if range_m <= FARTHEST_RANGE_M => Reading::At(range_m.max(NEAREST_RANGE_M)),
                _ => Reading::Free,
            }
        });
        Self { time_us, position_m, heading_rad, sectors }
    }

    /// Adds what a later scan shows whose first sector has the same heading: the nearer thing counts.
    pub(crate) fn merge(&mut self, later: &Self) {
        for (known, news) in self.sectors.iter_mut().zip(later.sectors) {
            *known = known.nearer(news);
        }
        (self.time_us, self.position_m) = (later.time_us, later.position_m);
    }

    /// The nearest thing in each of some equal parts of the turn, the first of them around a heading, rad; m.
    pub fn nearest_m<const PARTS: usize>(&self, heading_rad: f64) -> [Option<f64>; PARTS] {
        let mut nearest_m = [None; PARTS];
        for (reading, sector) in self.sectors.iter().zip(0..) {
            let Reading::At(range_m) = *reading else { continue };
            let off = (self.heading_rad + f64::from(sector) * SECTOR_RAD - heading_rad) / TAU * PARTS as f64;
            let part = (libm::floor(off + 0.5) as i64).rem_euclid(PARTS as i64) as usize;
            if let Some(nearest) = nearest_m.get_mut(part) {
                *nearest = Some(nearest.map_or(range_m, |other: f64| other.min(range_m)));
            }
        }
        nearest_m
    }

    /// Where things are, seen from a place, NED, m: north and east, m.
    pub fn seen_from(&self, position_m: Vector3<f64>) -> impl Iterator<Item = Vector2<f64>> {
        let moved_m = (self.position_m - position_m).xy();
        self.sectors.iter().zip(0..).filter_map(move |(reading, sector)| match reading {
            Reading::At(range_m) => {
                let direction = ahead(self.heading_rad + f64::from(sector) * SECTOR_RAD).xy();
                Some(moved_m + direction * *range_m)
            }
            Reading::Unknown | Reading::Free => None,
        })
    }
}
