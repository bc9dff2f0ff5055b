//! Line charts as SVG.

use std::fmt::Write;

/// A picture of charts.
pub struct Svg {
    body: String,
    width: f64,
    height: f64,
}

/// A chart: axes, grid and lines.
pub struct Chart {
    /// Left, top, width and height of the area of the lines.
    pub place: (f64, f64, f64, f64),
    /// Values at the left and right edge.
    pub x_range: (f64, f64),
    /// Values at the lower and upper edge.
    pub y_range: (f64, f64),
    /// Distance of the vertical grid lines.
    pub x_step: f64,
    /// Distance of the horizontal grid lines.
    pub y_step: f64,
    /// What is across.
    pub x_title: &'static str,
    /// What is up.
    pub y_title: &'static str,
    /// In the order of drawing.
    pub lines: Vec<Line>,
}

/// Name of all references.
const REFERENCE: &str = "reference";

/// A line through points, and its name in the legend.
pub struct Line {
    points: Vec<(f64, f64)>,
    style: String,
    name: &'static str,
}

impl Line {
    /// A coloured line of some width with a name. `dashes` are lengths of dashes and gaps, or "none" for a solid line.
    pub fn new(
        points: Vec<(f64, f64)>,
        colour: &'static str,
        width: f64,
        dashes: &'static str,
        name: &'static str,
    ) -> Self {
        let style = format!("stroke=\"{colour}\" stroke-width=\"{width}\" stroke-dasharray=\"{dashes}\"");
        Self { points, style, name }
    }

    /// A thin dotted line for a reference.
    pub fn dashed(points: Vec<(f64, f64)>) -> Self {
        Self { points, style: "stroke=\"#333\" stroke-dasharray=\"1 3\"".to_owned(), name: REFERENCE }
    }
}

impl Svg {
    /// An empty picture.
    pub fn new(width: f64, height: f64) -> Self {
        Self { body: String::new(), width, height }
    }

    /// Draws a chart.
    pub fn draw(&mut self, chart: &Chart) {
        self.grid(chart);
        let (left, top, width, height) = chart.place;
        for line in &chart.lines {
            let points: String = line
                .points
                .iter()
                .map(|&(x, y)| format!("{:.1},{:.1} ", chart.across(x), chart.down(y)))
                .collect();
            self.element(format_args!(
                "<polyline fill=\"none\" {} points=\"{}\"/>",
                line.style,
                points.trim_end()
            ));
        }
        self.element(format_args!(
            "<rect x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" fill=\"none\" stroke=\"#333\"/>"
        ));
        self.legend(chart);
    }

    /// The SVG element.
    pub fn finish(self) -> String {
        let Self { body, width, height } = self;
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" \
             height=\"{height}\" font-family=\"sans-serif\" font-size=\"15\" role=\"img\">\n{body}</svg>"
        )
    }

    fn grid(&mut self, chart: &Chart) {
        let (left, top, width, height) = chart.place;
        let (right, bottom) = (left + width, top + height);
        for value in chart.ticks(chart.x_range, chart.x_step) {
            let x = chart.across(value);
            self.element(format_args!(
                "<line x1=\"{x:.1}\" y1=\"{top}\" x2=\"{x:.1}\" y2=\"{bottom}\" stroke=\"#ddd\"/>"
            ));
            self.text(x, bottom + 17.0, "middle", &format!("{value}"));
        }
        for value in chart.ticks(chart.y_range, chart.y_step) {
            let y = chart.down(value);
            self.element(format_args!(
                "<line x1=\"{left}\" y1=\"{y:.1}\" x2=\"{right}\" y2=\"{y:.1}\" stroke=\"#ddd\"/>"
            ));
            self.text(left - 6.0, y + 4.0, "end", &format!("{value}"));
        }
        self.text(left + width / 2.0, bottom + 36.0, "middle", chart.x_title);
        let (x, y) = (left - 46.0, top + height / 2.0);
        self.element(format_args!(
            "<text x=\"{x}\" y=\"{y}\" text-anchor=\"middle\" transform=\"rotate(-90 {x} {y})\">{}</text>",
            chart.y_title
        ));
    }

    fn legend(&mut self, chart: &Chart) {
        let (left, top, width, _) = chart.place;
        // References look alike: one entry is enough.
        let mut entries: Vec<&Line> = chart.lines.iter().collect();
        entries.dedup_by_key(|line| line.name);
        for (row, Line { style, name, .. }) in entries.into_iter().enumerate() {
            let (x, y) = (left + width + 14.0, top + 12.0 + 20.0 * row as f64);
            self.element(format_args!(
                "<line x1=\"{x}\" y1=\"{y}\" x2=\"{}\" y2=\"{y}\" {style}/>",
                x + 34.0
            ));
            self.text(x + 40.0, y + 4.0, "start", name);
        }
    }

    fn text(&mut self, x: f64, y: f64, anchor: &str, text: &str) {
        if !text.is_empty() {
            self.element(format_args!(
                "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{text}</text>"
            ));
        }
    }

    fn element(&mut self, element: std::fmt::Arguments) {
        // Writing to a String cannot fail.
        let _ = writeln!(self.body, "{element}");
    }
}

impl Chart {
    fn across(&self, x: f64) -> f64 {
        let (left, _, width, _) = self.place;
        left + width * (x - self.x_range.0) / (self.x_range.1 - self.x_range.0)
    }

    fn down(&self, y: f64) -> f64 {
        let (_, top, _, height) = self.place;
        top + height * (self.y_range.1 - y) / (self.y_range.1 - self.y_range.0)
    }

    fn ticks(&self, range: (f64, f64), step: f64) -> impl Iterator<Item = f64> + use<> {
        let count = ((range.1 - range.0) / step).floor() as u32;
        (0..=count).map(move |tick| range.0 + step * f64::from(tick))
    }
}
