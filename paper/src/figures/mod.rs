//! Figures as SVG, and their PNG copies.
//!
//! ```text
//! svg ◄─ scale ◄─ line_chart, heat_map, path_figure, eigenvalue_figure ─► png
//! ```

mod eigenvalue_figure;
mod heat_map;
mod line_chart;
mod path_figure;
mod png;
mod scale;
mod svg;

pub use eigenvalue_figure::eigenvalue_figure;
pub use heat_map::{HeatMap, heat_maps};
pub use line_chart::{Line, Panel, line_chart};
pub use path_figure::{Path, path_figure};
pub use png::png;
pub use scale::Scale;

/// A figure of the page.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Name of its file, without an ending.
    pub name: String,
    /// What stands under it.
    pub caption: String,
    /// The picture.
    pub svg: String,
}

/// Okabe and Ito's colours, which the colour-blind tell apart: blue, vermilion, green, purple, orange, sky, black.
pub const COLOURS: [&str; 7] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#333333"];
/// What lines of references and limits look like.
pub const REFERENCE: &str = "#333333";
/// See [`REFERENCE`].
pub const LIMIT: &str = "#aa0000";
