//! Flight paths in space, in parallel projection.

use super::line_chart::Line;
use super::scale::{AxisRange, Scale};
use super::svg::{Anchor, Svg};

/// Azimuth and elevation of the eye, rad: from the south-east, above.
const AZIMUTH: f64 = 0.6;
const ELEVATION: f64 = 0.38;
const SIZE: [f64; 2] = [720.0, 540.0];
/// Pixels per unit cube edge.
const ZOOM: f64 = 300.0;

/// A path: north, east, altitude, m; the line's own points are not used.
pub type Path = (Line, Vec<[f64; 3]>);

/// Paths above their shadows on the ground.
pub fn path_figure(title: &str, paths: &[Path]) -> String {
    let axis = |index: usize| {
        let values = paths.iter().flat_map(|(_, points)| points.iter().map(move |point| point[index]));
        AxisRange::around(values.chain([0.0]), Scale::Linear, 1.0)
    };
    let axes = [axis(0), axis(1), axis(2)];
    let mut svg = Svg::new(title, SIZE[0], SIZE[1]);
    frame(&mut svg, &axes);
    for (line, points) in paths {
        let shadow: Vec<[f64; 2]> =
            points.iter().map(|point| projected(shares(&axes, point).map_third(0.0))).collect();
        svg.line(&shadow, "#bbbbbb", 1.0, line.dash);
        let seen: Vec<[f64; 2]> = points.iter().map(|point| projected(shares(&axes, point))).collect();
        svg.line(&seen, line.colour, 2.0, line.dash);
        for (end, colour) in [(seen.first(), "#333333"), (seen.last(), line.colour)] {
            if let Some(end) = end {
                svg.circle(*end, 3.5, colour, "white", 0.8);
            }
        }
    }
    let named = paths.iter().filter(|(line, _)| !line.label.is_empty());
    for (row, (line, _)) in named.enumerate() {
        let y = 26.0 + 20.0 * row as f64;
        svg.line(&[[SIZE[0] - 250.0, y - 4.0], [SIZE[0] - 230.0, y - 4.0]], line.colour, 2.0, line.dash);
        svg.text([SIZE[0] - 224.0, y], Anchor::Start, "#333", &line.label);
    }
    svg.finish()
}

/// Shares of the three axes.
struct Shares([f64; 3]);

impl Shares {
    fn map_third(self, third: f64) -> Self {
        Self([self.0[0], self.0[1], third])
    }
}

fn shares(axes: &[AxisRange; 3], point: &[f64; 3]) -> Shares {
    Shares(std::array::from_fn(|index| axes[index].share(point[index])))
}

/// North to the upper left, east to the right, altitude upwards.
fn projected(Shares([north, east, up]): Shares) -> [f64; 2] {
    let (north, east) = (north - 0.5, east - 0.5);
    let right = east * AZIMUTH.cos() - north * AZIMUTH.sin();
    let away = east * AZIMUTH.sin() + north * AZIMUTH.cos();
    [
        0.42 * SIZE[0] + 1.15 * ZOOM * right,
        0.72 * SIZE[1] - ZOOM * (away * ELEVATION.sin() + 1.1 * up * ELEVATION.cos()),
    ]
}

/// Ground grid, the vertical axis, and names.
fn frame(svg: &mut Svg, axes: &[AxisRange; 3]) {
    let at = |north: f64, east: f64, up: f64| projected(Shares([north, east, up]));
    for (value, name) in axes[0].ticks(5) {
        let share = axes[0].share(value);
        svg.line(&[at(share, 0.0, 0.0), at(share, 1.0, 0.0)], "#ddd", 1.0, "");
        let [x, y] = at(share, 1.0, 0.0);
        svg.text([x + 8.0, y + 10.0], Anchor::Start, "#333", &name);
    }
    for (value, name) in axes[1].ticks(5) {
        let share = axes[1].share(value);
        svg.line(&[at(0.0, share, 0.0), at(1.0, share, 0.0)], "#ddd", 1.0, "");
        let [x, y] = at(0.0, share, 0.0);
        svg.text([x + 6.0, y + 18.0], Anchor::Middle, "#333", &name);
    }
    for (value, name) in axes[2].ticks(6) {
        let share = axes[2].share(value);
        svg.line(&[at(1.0, 0.0, share), at(1.0, 1.0, share)], "#eee", 1.0, "");
        svg.line(&[at(0.0, 0.0, share), at(1.0, 0.0, share)], "#eee", 1.0, "");
        let [x, y] = at(0.0, 0.0, share);
        svg.text([x - 8.0, y + 4.0], Anchor::End, "#333", &name);
    }
    for corner in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]] {
        svg.line(&[at(corner[0], corner[1], 0.0), at(corner[0], corner[1], 1.0)], "#999", 1.0, "");
    }
    let outline =
        [at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0), at(1.0, 1.0, 0.0), at(0.0, 1.0, 0.0), at(0.0, 0.0, 0.0)];
    svg.line(&outline, "#999", 1.0, "");
    let [x, y] = at(0.5, 1.0, 0.0);
    svg.text([x + 44.0, y + 2.0], Anchor::Start, "#333", "north, m");
    let [x, y] = at(0.0, 0.5, 0.0);
    svg.text([x + 20.0, y + 40.0], Anchor::Middle, "#333", "east, m");
    let [x, y] = at(0.0, 0.0, 0.5);
    svg.upward_text([x - 36.0, y], "altitude, m");
}
