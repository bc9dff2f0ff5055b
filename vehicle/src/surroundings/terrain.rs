//! The heights of the ground.

use core::f64::consts::PI;
use std::sync::Arc;

use libm::{cos, floor, hypot};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// The ground: flat, at z = 0, unless heights are given. A copy shares them.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
#[serde(from = "Option<Relief>", into = "Option<Relief>")]
pub struct Terrain {
    relief: Option<Arc<Relief>>,
}

/// Heights above z = 0: those of a grid, and hills that stand on it.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Relief {
    /// Measured heights, if there are any.
    pub grid: Option<HeightGrid>,
    /// What is added to them.
    pub hills: Vec<Hill>,
}

/// Heights at the corners of squares, bilinear between them. Beyond its edge the ground goes on as high as there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HeightGrid {
    /// North and east of the first height, m: the south-west corner.
    pub corner_m: [f64; 2],
    /// Side of the squares, m.
    pub spacing_m: f64,
    /// Rows from south to north, each from west to east and equally long: heights, m.
    pub rows_m: Vec<Vec<f64>>,
}

/// A round hill, or a hollow: level up to a radius, and from there a half wave of a cosine down to its foot.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Hill {
    /// North and east of its middle, m.
    pub centre_m: [f64; 2],
    /// Radius of its foot, m.
    pub radius_m: f64,
    /// Radius of its level top, m, less than that of its foot.
    pub top_m: f64,
    /// Its height, m; negative for a hollow.
    pub height_m: f64,
}

impl From<Option<Relief>> for Terrain {
    fn from(relief: Option<Relief>) -> Self {
        Self { relief: relief.map(Arc::new) }
    }
}

impl From<Terrain> for Option<Relief> {
    fn from(terrain: Terrain) -> Self {
        terrain.relief.map(|relief| (*relief).clone())
    }
}

impl Terrain {
    /// The ground with these heights.
    pub fn new(relief: Relief) -> Self {
        Self::from(Some(relief))
    }

    /// Whether it is flat.
    #[inline]
    pub fn is_flat(&self) -> bool {
        self.relief.is_none()
    }

    /// South-west and north-east corner of what heights are given for, north and east, m: the grid and the feet of the hills. `None`
    /// for flat ground.
    pub fn extent_m(&self) -> Option<[[f64; 2]; 2]> {
        let relief = self.relief.as_ref()?;
        let grid = relief.grid.as_ref().map(HeightGrid::extent_m);
        let hills = relief.hills.iter().map(Hill::extent_m);
        grid.into_iter().chain(hills).reduce(|[low, high], [other_low, other_high]| {
            [
                [0, 1].map(|axis| low[axis].min(other_low[axis])),
                [0, 1].map(|axis| high[axis].max(other_high[axis])),
            ]
        })
    }

    /// z of the ground, NED, m, at a place north and east of the origin, m.
    #[inline]
    pub fn z_m(&self, [north_m, east_m]: [f64; 2]) -> f64 {
        match &self.relief {
            Some(relief) => -relief.height_m([north_m, east_m]),
            None => 0.0,
        }
    }

    /// z of the ground below or above a place, NED, m.
    #[inline]
    pub fn z_below_m(&self, place_m: &Vector3<f64>) -> f64 {
        self.z_m([place_m.x, place_m.y])
    }

    /// How far a ray from a place, NED, m, goes in a direction of length one before it meets the ground, m, if that is nearer than
    /// `farthest_m`. What lies in the ground is at no distance.
    pub fn along_m(&self, place_m: &Vector3<f64>, direction: &Vector3<f64>, farthest_m: f64) -> Option<f64> {
        /// What is shorter than this, m, along a ray may be missed.
        const STEP_M: f64 = 0.5;
        const HALVINGS: usize = 40;
        let above_m = |along_m: f64| {
            let there_m = place_m + direction * along_m;
            self.z_below_m(&there_m) - there_m.z
        };
        let mut free_m = 0.0;
        if above_m(free_m) <= 0.0 {
            return Some(0.0);
        }
        while free_m < farthest_m {
            let next_m = farthest_m.min(free_m + STEP_M);
            if above_m(next_m) <= 0.0 {
                let (mut near_m, mut far_m) = (free_m, next_m);
                for _ in 0..HALVINGS {
                    let middle_m = (near_m + far_m) / 2.0;
                    if above_m(middle_m) > 0.0 { near_m = middle_m } else { far_m = middle_m }
                }
                return Some(far_m);
            }
            free_m = next_m;
        }
        None
    }
}

impl Relief {
    /// Height, m, at a place north and east of the origin, m.
    #[inline(never)]
    fn height_m(&self, place_m: [f64; 2]) -> f64 {
        let measured_m = self.grid.as_ref().map_or(0.0, |grid| grid.height_m(place_m));
        self.hills.iter().fold(measured_m, |height_m, hill| height_m + hill.height_m(place_m))
    }
}

impl HeightGrid {
    fn extent_m(&self) -> [[f64; 2]; 2] {
        let sides = [self.rows_m.len(), self.rows_m.first().map_or(0, Vec::len)];
        let end_m = |axis: usize| self.corner_m[axis] + self.spacing_m * sides[axis].saturating_sub(1) as f64;
        [self.corner_m, [end_m(0), end_m(1)]]
    }

    fn height_m(&self, place_m: [f64; 2]) -> f64 {
        let last_row = self.rows_m.len().saturating_sub(1);
        let last_column = self.rows_m.first().map_or(0, |row| row.len().saturating_sub(1));
        let (south, up) = self.square(place_m[0] - self.corner_m[0], last_row);
        let (west, right) = self.square(place_m[1] - self.corner_m[1], last_column);
        let corner_m = |row: usize, column: usize| {
            let row = self.rows_m.get(row.min(last_row));
            row.and_then(|row| row.get(column.min(last_column))).copied().unwrap_or(0.0)
        };
        let between_m = |row| corner_m(row, west) * (1.0 - right) + corner_m(row, west + 1) * right;
        between_m(south) * (1.0 - up) + between_m(south + 1) * up
    }

    /// The square that a distance from the corner, m, lies in, and the share of its side.
    fn square(&self, distance_m: f64, last: usize) -> (usize, f64) {
        let sides = (distance_m / self.spacing_m).clamp(0.0, last as f64);
        (floor(sides) as usize, sides - floor(sides))
    }
}

impl Hill {
    fn extent_m(&self) -> [[f64; 2]; 2] {
        [
            self.centre_m.map(|middle_m| middle_m - self.radius_m),
            self.centre_m.map(|middle_m| middle_m + self.radius_m),
        ]
    }

    fn height_m(&self, [north_m, east_m]: [f64; 2]) -> f64 {
        let off_m = hypot(north_m - self.centre_m[0], east_m - self.centre_m[1]);
        if off_m >= self.radius_m {
            return 0.0;
        }
        let down = ((off_m - self.top_m) / (self.radius_m - self.top_m)).max(0.0);
        self.height_m * (1.0 + cos(PI * down)) / 2.0
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::{HeightGrid, Hill, Relief, Terrain};

    /// Rises by 1 m per 10 m to the north and by 2 m per 10 m to the east, from 5 m.
    fn slope() -> Terrain {
        let rows_m = vec![vec![5.0, 7.0, 9.0], vec![6.0, 8.0, 10.0]];
        let grid = Some(HeightGrid { corner_m: [-5.0, -10.0], spacing_m: 10.0, rows_m });
        Terrain::new(Relief { grid, hills: Vec::new() })
    }

    #[test]
    fn a_grid_is_bilinear_and_goes_on_level_beyond_its_edge() {
        for (place_m, height_m) in [
            ([-5.0, -10.0], 5.0),
            ([5.0, 10.0], 10.0),
            ([0.0, 0.0], 7.5),
            ([2.5, -4.0], 5.0 + 0.75 + 1.2),
            ([-100.0, 0.0], 7.0),
            ([100.0, 1e9], 10.0),
        ] {
            assert!((slope().z_m(place_m) + height_m).abs() < 1e-12, "{place_m:?}");
        }
        assert_eq!(Terrain::default().z_m([3.0, -4.0]).to_bits(), 0.0_f64.to_bits());
    }

    #[test]
    fn a_hill_has_a_top_and_a_foot() {
        let hill = Hill { centre_m: [10.0, 20.0], radius_m: 30.0, top_m: 10.0, height_m: 8.0 };
        let terrain = Terrain::new(Relief { grid: None, hills: vec![hill] });
        for (off_m, height_m) in [(0.0, 8.0), (10.0, 8.0), (20.0, 4.0), (30.0, 0.0), (31.0, 0.0)] {
            assert!((terrain.z_m([10.0 + off_m, 20.0]) + height_m).abs() < 1e-12, "{off_m} m");
        }
    }

    #[test]
    fn heights_are_given_for_the_grid_and_up_to_the_feet_of_the_hills() {
        assert_eq!(Terrain::default().extent_m(), None);
        assert_eq!(slope().extent_m(), Some([[-5.0, -10.0], [5.0, 10.0]]));
        let hill = Hill { centre_m: [10.0, 20.0], radius_m: 30.0, top_m: 10.0, height_m: 8.0 };
        let grid = HeightGrid { corner_m: [-30.0, 0.0], spacing_m: 10.0, rows_m: vec![vec![1.0; 8]; 2] };
        let both = Terrain::new(Relief { grid: Some(grid), hills: vec![hill] });
        assert_eq!(both.extent_m(), Some([[-30.0, -10.0], [40.0, 70.0]]));
    }

    /// Over a plane z = −7.5 − 0.1 n − 0.2 e a ray from (0, 0, −17.5) along d meets it after 10/(d_z + 0.1 d_n + 0.2 d_e).
    #[test]
    fn rays_meet_a_slope_where_they_should() {
        for direction in [[0.0, 0.0, 1.0], [0.3, -0.2, 1.0], [0.1, 0.4, 0.8]] {
            let direction = Vector3::from(direction).normalize();
            let expected_m = 10.0 / (direction.z + 0.1 * direction.x + 0.2 * direction.y);
            let found_m = slope().along_m(&Vector3::new(0.0, 0.0, -17.5), &direction, 40.0);
            let found_m = found_m.filter(|_| expected_m * direction.x < 5.0).expect("within the grid");
            assert!((found_m - expected_m).abs() < 1e-6, "{found_m}, expected {expected_m}");
        }
        let up = Vector3::new(0.0, 0.0, -1.0);
        assert_eq!(slope().along_m(&Vector3::new(0.0, 0.0, -17.5), &up, 40.0), None);
        assert_eq!(slope().along_m(&Vector3::zeros(), &up, 40.0), Some(0.0), "in the ground");
    }
}
