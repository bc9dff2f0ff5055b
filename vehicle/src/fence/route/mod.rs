//! The shortest way around the areas to stay out of, within those to stay in.
//!
//! ```text
//!  fence ─► ground: is a straight way free?  ┐
//!    └────► corners: where a way can bend    ┴─► graph: shortest way over corners (A*) ─► search: with all areas that matter
//! ```

mod corners;
mod graph;
mod ground;
mod search;

pub use search::{Progress, RouteSearch};
