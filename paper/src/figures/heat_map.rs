//! Tables of numbers as colours.

use super::scale::{AxisRange, Scale};
use super::svg::{Anchor, Svg};

/// One table; rows from top to bottom.
#[derive(Clone, Debug, PartialEq)]
pub struct HeatMap {
    /// What stands above it.
    pub title: String,
    /// What stands under it.
    pub x_label: String,
    /// What stands beside it.
    pub y_label: String,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Names of the rows.
    pub rows: Vec<String>,
    /// Numbers row by row; none where there is nothing to show.
    pub values: Vec<Vec<Option<f64>>>,
    /// Row and column of the cell to point out.
    pub marked: Option<[usize; 2]>,
}

const CELL: [f64; 2] = [35.0, 21.0];
const LEFT: f64 = 62.0;
const RIGHT: f64 = 10.0;
const TOP: f64 = 30.0;
const BOTTOM: f64 = 46.0;
const BAR: f64 = 46.0;

/// Colours from low to high: viridis turned round, at even steps.
const STOPS: [[f64; 3]; 6] = [
    [253.0, 231.0, 37.0],
    [122.0, 209.0, 81.0],
    [34.0, 168.0, 132.0],
    [42.0, 120.0, 142.0],
    [65.0, 68.0, 135.0],
    [68.0, 1.0, 84.0],
];

/// Tables side by side in rows of `across`, under one logarithmic scale of colours from `low` to `high`, with a note
/// on what grey cells are.
pub fn heat_maps(
    title: &str,
    unit: &str,
    [low, high]: [f64; 2],
    empty: &str,
    across: usize,
    maps: &[HeatMap],
) -> String {
    let columns = maps.iter().map(|map| map.columns.len()).max().unwrap_or(0) as f64;
    let rows = maps.iter().map(|map| map.rows.len()).max().unwrap_or(0) as f64;
    let size = [LEFT + RIGHT + CELL[0] * columns, TOP + BOTTOM + CELL[1] * rows];
    let down = maps.len().div_ceil(across) as f64;
    let range = AxisRange::exactly(low, high, Scale::Logarithmic);
    let mut svg = Svg::new(title, size[0] * across as f64, BAR + size[1] * down);
    colour_bar(&mut svg, unit, &range, empty);
    for (index, map) in maps.iter().enumerate() {
        let corner = [size[0] * (index % across) as f64, BAR + size[1] * (index / across) as f64];
        draw(&mut svg, map, &range, corner);
    }
    svg.finish()
}

fn draw(svg: &mut Svg, map: &HeatMap, range: &AxisRange, [left, top]: [f64; 2]) {
    let (left, top) = (left + LEFT, top + TOP);
    let (width, height) = (CELL[0] * map.columns.len() as f64, CELL[1] * map.rows.len() as f64);
    for (row, values) in map.values.iter().enumerate() {
        for (column, value) in values.iter().enumerate() {
            let corner = [left + CELL[0] * column as f64, top + CELL[1] * row as f64];
            cell(svg, corner, *value, range);
        }
    }
    if let Some([row, column]) = map.marked {
        let corner = [left + CELL[0] * column as f64 + 1.0, top + CELL[1] * row as f64 + 1.0];
        for (inset, colour) in [(0.0, "#d00000"), (1.0, "#d00000")] {
            let inner = [CELL[0] - 2.0 - 2.0 * inset, CELL[1] - 2.0 - 2.0 * inset];
            svg.rectangle([corner[0] + inset, corner[1] + inset], inner, "none", colour);
        }
    }
    for (column, name) in map.columns.iter().enumerate() {
        let x = left + CELL[0] * (column as f64 + 0.5);
        svg.sized_text([x, top + height + 15.0], Anchor::Middle, "#333", 10.0, name);
    }
    for (row, name) in map.rows.iter().enumerate() {
        svg.text([left - 6.0, top + CELL[1] * (row as f64 + 0.7)], Anchor::End, "#333", name);
    }
    svg.sized_text([left + width / 2.0, top - 8.0], Anchor::Middle, "#111", 13.0, &map.title);
    svg.text([left + width / 2.0, top + height + 33.0], Anchor::Middle, "#333", &map.x_label);
    svg.upward_text([left - 48.0, top + height / 2.0], &map.y_label);
}

fn cell(svg: &mut Svg, corner: [f64; 2], value: Option<f64>, range: &AxisRange) {
    let Some(value) = value else {
        svg.rectangle(corner, CELL, "#cccccc", "white");
        return;
    };
    let share = range.share(value).clamp(0.0, 1.0);
    svg.rectangle(corner, CELL, &colour(share), "white");
    let ink = if share > 0.55 { "white" } else { "#111" };
    let middle = [corner[0] + CELL[0] / 2.0, corner[1] + 0.7 * CELL[1]];
    svg.sized_text(middle, Anchor::Middle, ink, 10.0, &number(value));
}

/// Two digits are enough beside a colour.
fn number(value: f64) -> String {
    match value {
        value if value < 0.0005 => "0".to_owned(),
        value if value < 0.01 => format!("{value:.3}"),
        value if value < 1.0 => format!("{value:.2}"),
        value if value < 10.0 => format!("{value:.1}"),
        value if value < 1000.0 => format!("{value:.0}"),
        value => format!("{value:.0e}"),
    }
}

fn colour_bar(svg: &mut Svg, unit: &str, range: &AxisRange, empty: &str) {
    const STEPS: usize = 60;
    let (left, width) = (LEFT, 300.0);
    for step in 0..STEPS {
        let share = step as f64 / STEPS as f64;
        let colour = colour(share);
        svg.rectangle([left + width * share, 8.0], [width / STEPS as f64 + 0.5, 12.0], &colour, "none");
    }
    for (value, name) in range.ticks(5) {
        svg.text([left + width * range.share(value), 35.0], Anchor::Middle, "#333", &name);
    }
    svg.text([left + width + 20.0, 19.0], Anchor::Start, "#333", unit);
    svg.rectangle([left + width + 20.0, 27.0], [20.0, 11.0], "#cccccc", "white");
    svg.text([left + width + 46.0, 37.0], Anchor::Start, "#333", empty);
}

fn colour(share: f64) -> String {
    let place = share * (STOPS.len() - 1) as f64;
    let index = (place as usize).min(STOPS.len() - 2);
    let part = place - index as f64;
    let mixed = |channel: usize| STOPS[index][channel] * (1.0 - part) + STOPS[index + 1][channel] * part;
    format!("#{:02x}{:02x}{:02x}", mixed(0) as u8, mixed(1) as u8, mixed(2) as u8)
}
