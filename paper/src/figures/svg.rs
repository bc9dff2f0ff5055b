//! Writing SVG: the few shapes that our figures are made of.

use std::fmt::Write;

/// Where a text is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// At its start.
    Start,
    /// At its middle.
    Middle,
    /// At its end.
    End,
}

/// A picture under way. Lengths are pixels, y points down.
#[derive(Clone, Debug, PartialEq)]
pub struct Svg {
    text: String,
}

impl Svg {
    /// An empty picture on white.
    pub fn new(title: &str, width: f64, height: f64) -> Self {
        let mut svg = Self { text: String::new() };
        svg.write(format_args!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" width=\"{width:.0}\" \
             height=\"{height:.0}\" role=\"img\" font-family=\"'Noto Sans','DejaVu Sans',sans-serif\" font-size=\"12\">\
             <title>{}</title><rect width=\"{width:.0}\" height=\"{height:.0}\" fill=\"white\"/>",
            escaped(title)
        ));
        svg
    }

    fn write(&mut self, arguments: std::fmt::Arguments<'_>) {
        // Writing to a string does not fail.
        let _ = self.text.write_fmt(arguments);
    }

    /// A line through points; `dash` as in SVG, empty for none.
    pub fn line(&mut self, points: &[[f64; 2]], colour: &str, width: f64, dash: &str) {
        if points.len() < 2 {
            return;
        }
        self.write(format_args!(
            "<polyline fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" stroke-linejoin=\"round\""
        ));
        if !dash.is_empty() {
            self.write(format_args!(" stroke-dasharray=\"{dash}\""));
        }
        self.write(format_args!(" points=\""));
        for [x, y] in points {
            self.write(format_args!("{x:.1},{y:.1} "));
        }
        self.write(format_args!("\"/>"));
    }

    /// A filled rectangle.
    pub fn rectangle(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2], fill: &str, stroke: &str) {
        self.write(format_args!(
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" fill=\"{fill}\" stroke=\"{stroke}\"/>"
        ));
    }

    /// A circle.
    pub fn circle(&mut self, [x, y]: [f64; 2], radius: f64, fill: &str, stroke: &str, width: f64) {
        self.write(format_args!(
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" fill=\"{fill}\" stroke=\"{stroke}\" stroke-width=\"{width}\"/>"
        ));
    }

    /// A line of text.
    pub fn text(&mut self, [x, y]: [f64; 2], anchor: Anchor, colour: &str, text: &str) {
        self.sized_text([x, y], anchor, colour, 12.0, text);
    }

    /// A line of text of some size.
    pub fn sized_text(&mut self, [x, y]: [f64; 2], anchor: Anchor, colour: &str, size: f64, text: &str) {
        let anchor = anchor_name(anchor);
        self.write(format_args!(
            "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" fill=\"{colour}\" font-size=\"{size}\">{}</text>",
            escaped(text)
        ));
    }

    /// A line of text that runs upwards.
    pub fn upward_text(&mut self, [x, y]: [f64; 2], text: &str) {
        self.write(format_args!(
            "<text transform=\"translate({x:.1},{y:.1}) rotate(-90)\" text-anchor=\"middle\" fill=\"#333\">{}</text>",
            escaped(text)
        ));
    }

    /// What follows is cut off outside a rectangle, until [`Svg::unclip`].
    pub fn clip(&mut self, name: &str, [x, y]: [f64; 2], [width, height]: [f64; 2]) {
        self.write(format_args!(
            "<clipPath id=\"{name}\"><rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\"/></clipPath>\
             <g clip-path=\"url(#{name})\">"
        ));
    }

    /// Ends [`Svg::clip`].
    pub fn unclip(&mut self) {
        self.write(format_args!("</g>"));
    }

    /// The finished picture.
    pub fn finish(mut self) -> String {
        self.write(format_args!("</svg>"));
        self.text
    }
}

fn anchor_name(anchor: Anchor) -> &'static str {
    match anchor {
        Anchor::Start => "start",
        Anchor::Middle => "middle",
        Anchor::End => "end",
    }
}

/// Text in XML.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// About how wide a text is, px: sans-serif letters are a little more than half as wide as they are high.
pub fn text_width(text: &str) -> f64 {
    6.6 * text.chars().count() as f64
}
