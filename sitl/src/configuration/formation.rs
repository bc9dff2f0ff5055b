//! `--formation line,5`: where the vehicles of a run stand at the start.

use std::str::FromStr;

/// How the starts lie to one another. The first vehicle of a line or a grid stands at home.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// One beside the other, to the east.
    Line,
    /// In rows to the east, row behind row to the north, about as many rows as columns.
    Grid,
    /// Around home, from north through east.
    Circle,
}

/// A shape and the distance between neighbours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Formation {
    /// The shape.
    pub shape: Shape,
    /// Distance between neighbours, m.
    pub spacing_m: f64,
}

/// Neighbours of the default airframe, 0.86 m from rotor tip to rotor tip, do not touch.
const LEAST_SPACING_M: f64 = 1.0;
/// The local frame's plane is the earth's surface within a metre over so wide a line of ten.
const MOST_SPACING_M: f64 = 200.0;

impl Default for Formation {
    fn default() -> Self {
        Self { shape: Shape::Line, spacing_m: 5.0 }
    }
}

impl Formation {
    /// North and east of home, m, where the vehicle of a number (from zero) stands among `count`.
    pub fn start_m(&self, number: usize, count: usize) -> [f64; 2] {
        let spacing = self.spacing_m;
        match self.shape {
            Shape::Line => [0.0, number as f64 * spacing],
            Shape::Grid => {
                let columns = (1..).find(|columns| columns * columns >= count).unwrap_or(1).max(1);
                [(number / columns) as f64 * spacing, (number % columns) as f64 * spacing]
            }
            Shape::Circle if count < 2 => [0.0; 2],
            Shape::Circle => {
                // A chord of 2 r sin(π/n) between neighbours.
                let radius = spacing / (2.0 * libm::sin(core::f64::consts::PI / count as f64));
                let angle = core::f64::consts::TAU * number as f64 / count as f64;
                [radius * libm::cos(angle), radius * libm::sin(angle)]
            }
        }
    }
}

impl FromStr for Formation {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || {
            format!(
                "invalid formation `{text}`; use line, grid or circle, optionally with ,SPACING: {LEAST_SPACING_M} to \
                 {MOST_SPACING_M} m between neighbours"
            )
        };
        let (shape, spacing) = text.split_once(',').map_or((text, None), |(shape, rest)| (shape, Some(rest)));
        let shape = match shape.trim() {
            "line" => Shape::Line,
            "grid" => Shape::Grid,
            "circle" => Shape::Circle,
            _ => return Err(wrong()),
        };
        let spacing_m = match spacing {
            Some(spacing) => spacing.trim().parse().map_err(|_| wrong())?,
            None => Self::default().spacing_m,
        };
        let fits = (LEAST_SPACING_M..=MOST_SPACING_M).contains(&spacing_m);
        if fits { Ok(Self { shape, spacing_m }) } else { Err(wrong()) }
    }
}

#[cfg(test)]
mod tests {
    use super::Formation;

    fn starts(text: &str, count: usize) -> Vec<[f64; 2]> {
        let formation: Formation = text.parse().expect(text);
        (0..count).map(|number| formation.start_m(number, count)).collect()
    }

    #[test]
    fn neighbours_are_as_far_apart_as_asked() {
        assert_eq!(starts("line,4", 3), [[0.0, 0.0], [0.0, 4.0], [0.0, 8.0]]);
        assert_eq!(starts("grid,2", 5), [[0.0, 0.0], [0.0, 2.0], [0.0, 4.0], [2.0, 0.0], [2.0, 2.0]]);
        assert_eq!(starts("grid", 1), [[0.0, 0.0]]);
        for count in 2..20 {
            let circle = starts("circle,3", count);
            for (number, [north, east]) in circle.iter().enumerate() {
                let [other_north, other_east] = circle[(number + 1) % count];
                let apart = f64::hypot(north - other_north, east - other_east);
                assert!((apart - 3.0).abs() < 1e-9, "{count}: {apart}");
            }
        }
    }

    #[test]
    fn what_is_no_formation_is_refused_with_its_limits() {
        for wrong in ["", "row", "line,", "line,0.5", "grid,201", "circle,NaN", "line,5,5"] {
            assert!(wrong.parse::<Formation>().expect_err(wrong).contains("1 to 200 m"), "{wrong}");
        }
    }
}
