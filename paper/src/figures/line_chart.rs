//! Lines over a common horizontal axis, in panels.

use super::scale::{AxisRange, Scale};
use super::svg::{Anchor, Svg, text_width};

/// One line.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Its name in the legend; empty for none.
    pub label: String,
    /// Its colour.
    pub colour: &'static str,
    /// Its width, px.
    pub width: f64,
    /// Its dashes as in SVG; empty for none.
    pub dash: &'static str,
    /// Whether points are marked.
    pub marked: bool,
    /// x and y. Values that are not finite interrupt the line.
    pub points: Vec<[f64; 2]>,
}

impl Line {
    /// A plain line.
    pub fn new(label: impl Into<String>, colour: &'static str, points: Vec<[f64; 2]>) -> Self {
        Self { label: label.into(), colour, width: 1.6, dash: "", marked: false, points }
    }

    /// Dashed.
    pub fn dashed(self) -> Self {
        Self { dash: "5,3", width: 1.3, ..self }
    }

    /// With its points marked.
    pub fn marked(self) -> Self {
        Self { marked: true, ..self }
    }
}

/// One pair of axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// What stands above it.
    pub title: String,
    /// What stands under it, with a unit.
    pub x_label: String,
    /// What stands beside it, with a unit.
    pub y_label: String,
    /// How x is spread.
    pub x_scale: Scale,
    /// How y is spread.
    pub y_scale: Scale,
    /// Least span of y.
    pub y_span: f64,
    /// The range of y, where the lines do not give it.
    pub y_range: Option<[f64; 2]>,
    /// The lines.
    pub lines: Vec<Line>,
}

impl Panel {
    /// Linear axes around all lines.
    pub fn new(title: impl Into<String>, x_label: &str, y_label: &str, lines: Vec<Line>) -> Self {
        Self {
            title: title.into(),
            x_label: x_label.to_owned(),
            y_label: y_label.to_owned(),
            x_scale: Scale::Linear,
            y_scale: Scale::Linear,
            y_span: 0.0,
            y_range: None,
            lines,
        }
    }

    /// At least this span of y.
    pub fn with_span(self, y_span: f64) -> Self {
        Self { y_span, ..self }
    }

    /// Logarithmic y.
    pub fn logarithmic(self) -> Self {
        Self { y_scale: Scale::Logarithmic, ..self }
    }

    /// This range of y.
    pub fn with_range(self, low: f64, high: f64) -> Self {
        Self { y_range: Some([low, high]), ..self }
    }
}

const LEFT: f64 = 66.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 26.0;
const BOTTOM: f64 = 42.0;
const LEGEND_ROW: f64 = 20.0;
const LEGEND_MARK: f64 = 26.0;

/// Panels of one size in rows of `columns`, under one legend of all names.
pub fn line_chart(name: &str, title: &str, columns: usize, size: [f64; 2], panels: &[Panel]) -> String {
    let width = size[0] * columns as f64;
    let legend = legend(panels, width);
    let legend_height = 8.0 + LEGEND_ROW * legend.last().map_or(0.0, |entry| entry.row as f64 + 1.0);
    let rows = panels.len().div_ceil(columns);
    let mut svg = Svg::new(title, width, legend_height + size[1] * rows as f64);
    for entry in &legend {
        let y = 18.0 + LEGEND_ROW * entry.row as f64;
        let line = entry.line;
        svg.line(&[[entry.x, y - 4.0], [entry.x + LEGEND_MARK - 6.0, y - 4.0]], line.colour, 2.0, line.dash);
        if line.marked {
            svg.circle([entry.x + (LEGEND_MARK - 6.0) / 2.0, y - 4.0], 2.8, line.colour, "white", 0.6);
        }
        svg.text([entry.x + LEGEND_MARK, y], Anchor::Start, "#333", &line.label);
    }
    for (index, panel) in panels.iter().enumerate() {
        let corner = [size[0] * (index % columns) as f64, legend_height + size[1] * (index / columns) as f64];
        draw(&mut svg, panel, &format!("{name}-{index}"), corner, size);
    }
    svg.finish()
}

struct LegendEntry<'a> {
    line: &'a Line,
    x: f64,
    row: usize,
}

fn legend(panels: &[Panel], width: f64) -> Vec<LegendEntry<'_>> {
    let mut entries: Vec<LegendEntry<'_>> = Vec::new();
    let (mut x, mut row) = (LEFT, 0);
    for line in panels.iter().flat_map(|panel| &panel.lines) {
        if line.label.is_empty() || entries.iter().any(|entry| entry.line.label == line.label) {
            continue;
        }
        let needed = LEGEND_MARK + text_width(&line.label) + 16.0;
        if x + needed > width && x > LEFT {
            (x, row) = (LEFT, row + 1);
        }
        entries.push(LegendEntry { line, x, row });
        x += needed;
    }
    entries
}

/// Where a panel's values lie in the picture.
struct Frame {
    corner: [f64; 2],
    size: [f64; 2],
    x: AxisRange,
    y: AxisRange,
}

impl Frame {
    fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let clamped = |share: f64| share.clamp(-2.0, 3.0);
        [
            self.corner[0] + self.size[0] * clamped(self.x.share(x)),
            self.corner[1] + self.size[1] * (1.0 - clamped(self.y.share(y))),
        ]
    }
}

fn draw(svg: &mut Svg, panel: &Panel, clip: &str, corner: [f64; 2], size: [f64; 2]) {
    let values = |index: usize| {
        panel.lines.iter().flat_map(move |line| line.points.iter().map(move |point| point[index]))
    };
    let x = AxisRange::around(values(0), panel.x_scale, 0.0);
    let y = match panel.y_range {
        Some([low, high]) => AxisRange::exactly(low, high, panel.y_scale),
        None => AxisRange::around(values(1), panel.y_scale, panel.y_span),
    };
    let inner = [size[0] - LEFT - RIGHT, size[1] - TOP - BOTTOM];
    let frame = Frame { corner: [corner[0] + LEFT, corner[1] + TOP], size: inner, x, y };
    axes(svg, panel, &frame);
    svg.clip(clip, frame.corner, frame.size);
    for line in &panel.lines {
        for part in line.points.split(|point| point.iter().any(|value| !value.is_finite())) {
            let points: Vec<[f64; 2]> = part.iter().map(|point| frame.at(*point)).collect();
            svg.line(&points, line.colour, line.width, line.dash);
            if line.marked {
                for point in points {
                    svg.circle(point, 2.8, line.colour, "white", 0.6);
                }
            }
        }
    }
    svg.unclip();
}

fn axes(svg: &mut Svg, panel: &Panel, frame: &Frame) {
    let ([left, top], [width, height]) = (frame.corner, frame.size);
    let (right, bottom) = (left + width, top + height);
    for (value, name) in frame.x.ticks((width / 60.0) as usize) {
        let x = left + width * frame.x.share(value);
        svg.line(&[[x, top], [x, bottom]], "#ddd", 1.0, "");
        svg.text([x, bottom + 16.0], Anchor::Middle, "#333", &name);
    }
    for (value, name) in frame.y.ticks((height / 32.0) as usize) {
        let y = bottom - height * frame.y.share(value);
        svg.line(&[[left, y], [right, y]], "#ddd", 1.0, "");
        svg.text([left - 6.0, y + 4.0], Anchor::End, "#333", &name);
    }
    svg.rectangle(frame.corner, frame.size, "none", "#888");
    svg.sized_text([left + width / 2.0, top - 8.0], Anchor::Middle, "#111", 13.0, &panel.title);
    svg.text([left + width / 2.0, bottom + 33.0], Anchor::Middle, "#333", &panel.x_label);
    svg.upward_text([left - 50.0, top + height / 2.0], &panel.y_label);
}
