//! The ground in the file of `--world`: `[terrain]` and `[[hill]]`.

use serde::Deserialize;
use vehicle::surroundings::{HeightGrid, Hill, Relief, Terrain};

/// Heights that the ground can have, m.
const HEIGHTS_M: core::ops::RangeInclusive<f64> = -10_000.0..=10_000.0;
/// Sides of the squares of a grid, and radii of hills, m.
const SIZES_M: core::ops::RangeInclusive<f64> = 0.1..=100_000.0;

/// Heights in metres at the corners of squares: rows from south to north, each from west to east.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct GridTable {
    /// North and east of the first height, m.
    corner: [f64; 2],
    spacing: f64,
    heights: Vec<Vec<f64>>,
}

/// A round hill with a level top, or a hollow.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct HillTable {
    center: [f64; 2],
    radius: f64,
    #[serde(default)]
    top: f64,
    height: f64,
}

/// The ground of a file; flat if it has none.
///
/// # Errors
/// What is wrong: which value, and what is allowed.
pub(super) fn terrain(grid: Option<GridTable>, hills: Vec<HillTable>) -> Result<Terrain, String> {
    if grid.is_none() && hills.is_empty() {
        return Ok(Terrain::default());
    }
    let grid = grid.map(checked_grid).transpose()?;
    let hills = hills.into_iter().zip(1..).map(|(table, number)| checked_hill(&table, number));
    Ok(Terrain::new(Relief { grid, hills: hills.collect::<Result<_, _>>()? }))
}

fn checked_grid(table: GridTable) -> Result<HeightGrid, String> {
    within("terrain: spacing", table.spacing, *SIZES_M.start(), *SIZES_M.end())?;
    finite("terrain", table.corner)?;
    let columns = table.heights.first().map_or(0, Vec::len);
    if columns == 0 {
        return Err("terrain: no heights; give `heights` at least one row with one number".to_owned());
    }
    for (row, number) in table.heights.iter().zip(1..) {
        if row.len() != columns {
            return Err(format!(
                "terrain: row {number} has {} heights; the first one has {columns}",
                row.len()
            ));
        }
        let name = format!("terrain: row {number}: height");
        row.iter().try_for_each(|height| within(&name, *height, *HEIGHTS_M.start(), *HEIGHTS_M.end()))?;
    }
    Ok(HeightGrid { corner_m: table.corner, spacing_m: table.spacing, rows_m: table.heights })
}

fn checked_hill(table: &HillTable, number: usize) -> Result<Hill, String> {
    let name = format!("hill {number}");
    within(&format!("{name}: radius"), table.radius, *SIZES_M.start(), *SIZES_M.end())?;
    // Ground that rises like a wall throws up what touches it.
    within(&format!("{name}: top"), table.top, 0.0, table.radius - SIZES_M.start())?;
    within(&format!("{name}: height"), table.height, *HEIGHTS_M.start(), *HEIGHTS_M.end())?;
    finite(&name, table.center)?;
    Ok(Hill { centre_m: table.center, radius_m: table.radius, top_m: table.top, height_m: table.height })
}

fn within(name: &str, value: f64, least: f64, most: f64) -> Result<(), String> {
    if (least..=most).contains(&value) {
        return Ok(());
    }
    Err(format!("{name} {value} m; allowed {least} to {most} m"))
}

fn finite(name: &str, place: [f64; 2]) -> Result<(), String> {
    if place.iter().all(|value| value.is_finite()) {
        return Ok(());
    }
    Err(format!("{name}: its place must be finite numbers, m"))
}
