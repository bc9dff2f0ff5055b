//! `--world FILE.toml`: what stands around the vehicles.

use std::path::Path;

use serde::Deserialize;
use vehicle::surroundings::{Obstacle, Shape};

use super::text_file::{read_text, toml_mistake};
use crate::failure::Failure;

/// Sizes that an obstacle can have, m.
const SIZES_M: core::ops::RangeInclusive<f64> = 0.01..=10_000.0;
/// A wall that names no thickness, m.
const THICKNESS_M: f64 = 0.2;

/// The file: tables `[[box]]`, `[[cylinder]]` and `[[wall]]`. Lengths are in metres, headings in degrees; places are north and east of
/// the origin.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct WorldFile {
    #[serde(default, rename = "box")]
    boxes: Vec<BoxTable>,
    #[serde(default, rename = "cylinder")]
    cylinders: Vec<CylinderTable>,
    #[serde(default, rename = "wall")]
    walls: Vec<WallTable>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct BoxTable {
    name: Option<String>,
    center: [f64; 2],
    size: [f64; 2],
    #[serde(default)]
    heading: f64,
    #[serde(default)]
    bottom: f64,
    height: f64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct CylinderTable {
    name: Option<String>,
    center: [f64; 2],
    radius: f64,
    #[serde(default)]
    bottom: f64,
    height: f64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct WallTable {
    name: Option<String>,
    from: [f64; 2],
    to: [f64; 2],
    thickness: Option<f64>,
    height: f64,
}

/// Reads the obstacles of a file.
///
/// # Errors
/// [`Failure::File`], or [`Failure::Content`] that names the line or the obstacle, the value and what is allowed.
pub fn read_world(path: &Path) -> Result<Vec<Obstacle>, Failure> {
    parse(&read_text(path)?).map_err(|reason| Failure::Content { path: path.to_owned(), reason })
}

fn parse(text: &str) -> Result<Vec<Obstacle>, String> {
    let file: WorldFile = toml::from_str(text).map_err(|error| toml_mistake(text, &error))?;
    let boxes = file.boxes.into_iter().zip(1..).map(|(table, number)| Obstacle {
        name: table.name.unwrap_or_else(|| format!("box {number}")),
        shape: Shape::Box {
            centre_m: table.center,
            size_m: table.size,
            heading_rad: table.heading.to_radians(),
        },
        bottom_m: table.bottom,
        top_m: table.bottom + table.height,
    });
    let cylinders = file.cylinders.into_iter().zip(1..).map(|(table, number)| Obstacle {
        name: table.name.unwrap_or_else(|| format!("cylinder {number}")),
        shape: Shape::Cylinder { centre_m: table.center, radius_m: table.radius },
        bottom_m: table.bottom,
        top_m: table.bottom + table.height,
    });
    let walls = file.walls.into_iter().zip(1..).map(|(table, number)| {
        let name = table.name.unwrap_or_else(|| format!("wall {number}"));
        Obstacle::wall(name, table.from, table.to, table.thickness.unwrap_or(THICKNESS_M), table.height)
    });
    let obstacles: Vec<_> = boxes.chain(cylinders).chain(walls).collect();
    obstacles.iter().try_for_each(check)?;
    Ok(obstacles)
}

/// Whether an obstacle has a size, and stands somewhere.
fn check(obstacle: &Obstacle) -> Result<(), String> {
    let name = &obstacle.name;
    let (centre_m, sizes) = match obstacle.shape {
        Shape::Box { centre_m, size_m: [length, width], .. } => {
            (centre_m, vec![("size", length), ("size", width)])
        }
        Shape::Cylinder { centre_m, radius_m } => (centre_m, vec![("radius", radius_m)]),
    };
    let height = obstacle.top_m - obstacle.bottom_m;
    for (what, size_m) in sizes.into_iter().chain([("height", height)]) {
        if !SIZES_M.contains(&size_m) {
            return Err(format!(
                "{name}: {what} {size_m} m; allowed {} to {} m",
                SIZES_M.start(),
                SIZES_M.end()
            ));
        }
    }
    let [north, east] = centre_m;
    let placed = north.is_finite() && east.is_finite() && obstacle.bottom_m.is_finite();
    if placed { Ok(()) } else { Err(format!("{name}: its place must be finite numbers, m")) }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::parse;

    #[test]
    fn a_world_is_boxes_cylinders_and_walls() {
        let text = "[[box]]\nname = \"barn\"\ncenter = [10, 0]\nsize = [4, 2]\nheight = 5\n\
                    [[cylinder]]\ncenter = [0, 20]\nradius = 1.5\nheight = 30\nbottom = 2\n\
                    [[wall]]\nfrom = [-10, -10]\nto = [-10, 10]\nheight = 3\n";
        let obstacles = parse(text).expect("a world");
        let names: Vec<_> = obstacles.iter().map(|obstacle| obstacle.name.as_str()).collect();
        assert_eq!(names, ["barn", "cylinder 1", "wall 1"]);
        let origin = Vector3::new(0.0, 0.0, -2.5);
        let distances: Vec<_> = obstacles.iter().map(|obstacle| obstacle.distance_m(&origin)).collect();
        for (distance, expected) in distances.iter().zip([8.0, 18.5, 9.9]) {
            assert!((distance - expected).abs() < 1e-9, "{distances:?}");
        }
    }

    #[test]
    fn mistakes_are_named_with_their_place() {
        for (text, expected) in [
            ("[[box]]\ncenter = [1, 2]\nsize = [1, 1]\nhight = 3\n", "line 4"),
            (
                "[[cylinder]]\ncenter = [1, 2]\nradius = -1\nheight = 3\n",
                "cylinder 1: radius -1 m; allowed 0.01 to",
            ),
            ("[[wall]]\nfrom = [1, 2]\nto = [1, 2]\nheight = 3\n", "wall 1: size 0 m"),
        ] {
            let reason = parse(text).expect_err(text);
            assert!(reason.starts_with(expected), "{reason}");
        }
    }
}
