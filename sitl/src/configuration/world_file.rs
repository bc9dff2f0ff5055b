//! `--world FILE.toml`: the ground, and what stands on it.

use std::path::Path;

use serde::Deserialize;
use vehicle::surroundings::{Obstacle, Shape, Terrain};

use super::terrain_tables::{GridTable, HillTable, terrain};
use super::text_file::{read_text, toml_mistake};
use crate::failure::Failure;

/// Sizes that an obstacle can have, m.
const SIZES_M: core::ops::RangeInclusive<f64> = 0.01..=10_000.0;
/// A wall that names no thickness, m.
const THICKNESS_M: f64 = 0.2;

/// The file: tables `[[box]]`, `[[cylinder]]`, `[[wall]]` and `[[hill]]`, and one `[terrain]`. Lengths are in metres, headings in degrees; places are north and east of
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
    #[serde(rename = "terrain")]
    grid: Option<GridTable>,
    #[serde(default, rename = "hill")]
    hills: Vec<HillTable>,
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

/// Obstacles, and the ground that they stand on.
pub type World = (Vec<Obstacle>, Terrain);

/// Reads a file.
///
/// # Errors
/// [`Failure::File`], or [`Failure::Content`] that names the line or the part of the world, the value and what is allowed.
pub fn read_world(path: &Path) -> Result<World, Failure> {
    parse(&read_text(path)?).map_err(|reason| Failure::Content { path: path.to_owned(), reason })
}

fn parse(text: &str) -> Result<World, String> {
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
    let mut obstacles: Vec<_> = boxes.chain(cylinders).chain(walls).collect();
    obstacles.iter().try_for_each(check)?;
    let terrain = terrain(file.grid, file.hills)?;
    obstacles.iter_mut().for_each(|obstacle| stand(obstacle, &terrain));
    Ok((obstacles, terrain))
}

/// Puts an obstacle on the ground below its middle. What stands on it reaches down to where the ground is lower.
fn stand(obstacle: &mut Obstacle, terrain: &Terrain) {
    const ROOTS_M: f64 = 50.0;
    if terrain.is_flat() {
        return;
    }
    let (Shape::Box { centre_m, .. } | Shape::Cylinder { centre_m, .. }) = obstacle.shape;
    let height_m = -terrain.z_m(centre_m);
    let roots_m = if obstacle.bottom_m > 0.0 { 0.0 } else { ROOTS_M };
    obstacle.bottom_m += height_m - roots_m;
    obstacle.top_m += height_m;
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
        let (obstacles, terrain) = parse(text).expect("a world");
        assert!(terrain.is_flat());
        let names: Vec<_> = obstacles.iter().map(|obstacle| obstacle.name.as_str()).collect();
        assert_eq!(names, ["barn", "cylinder 1", "wall 1"]);
        let origin = Vector3::new(0.0, 0.0, -2.5);
        let distances: Vec<_> = obstacles.iter().map(|obstacle| obstacle.distance_m(&origin)).collect();
        for (distance, expected) in distances.iter().zip([8.0, 18.5, 9.9]) {
            assert!((distance - expected).abs() < 1e-9, "{distances:?}");
        }
    }

    /// A mast on a hill, 5 m high where it stands.
    #[test]
    fn obstacles_stand_on_the_ground() {
        let text = "[[hill]]\ncenter = [0, 0]\nradius = 40\nheight = 10\n\
                    [[cylinder]]\ncenter = [20, 0]\nradius = 1\nheight = 8\n";
        let (obstacles, terrain) = parse(text).expect("a world");
        let [mast] = obstacles.as_slice() else { panic!("{obstacles:?}") };
        assert!((terrain.z_m([20.0, 0.0]) + 5.0).abs() < 1e-9);
        assert!((mast.top_m - 13.0).abs() < 1e-9);
        assert_eq!(mast.distance_m(&Vector3::new(20.0, 0.0, -4.0)), 0.0, "it is rooted in the hill");
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
            (
                "[terrain]\ncorner = [0, 0]\nspacing = 0\nheights = [[1]]\n",
                "terrain: spacing 0 m; allowed 0.1 to",
            ),
            (
                "[terrain]\ncorner = [0, 0]\nspacing = 5\nheights = [[1, 2], [3]]\n",
                "terrain: row 2 has 1 heights; the first one has 2",
            ),
            (
                "[terrain]\ncorner = [0, 0]\nspacing = 5\nheights = [[1, nan]]\n",
                "terrain: row 1: height NaN m",
            ),
            ("[[hill]]\ncenter = [0, 0]\nradius = 5\ntop = 5\nheight = 1\n", "hill 1: top 5 m; allowed"),
        ] {
            let reason = parse(text).expect_err(text);
            assert!(reason.starts_with(expected), "{reason}");
        }
    }
}
