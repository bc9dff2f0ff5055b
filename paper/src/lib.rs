//! The paper's results, computed again (Chipofya, Lee, Chong 2015).
//!
//! ```text
//! tables ────────────┐
//! eigenvalues ───────┤                                       ┌─► report ─► report.html
//! constrained_step ──┼─► results (results.json, its schema) ─┤     ▲
//! flights ───────────┤                                       └─► figures ─► *.png
//! robustness ────────┤
//! bars ──────────────┘
//! design ◄─ model_file (--gain)
//! ```

pub mod bars;
mod constrained_step;
mod design;
mod eigenvalues;
mod error;
mod figures;
mod flights;
mod model_file;
mod progress;
mod report;
mod results;
mod robustness;
mod tables;
mod tuning;

pub use constrained_step::{CostResult, ExcessCost, TradeOff};
pub use design::{DesignResult, design};
pub use error::Error;
pub use figures::{Figure, png};
pub use flights::FlightResult;
pub use model_file::ModelFile;
pub use progress::Progress;
pub use report::{Page, report};
pub use results::{Results, parts, results, schema};
pub use robustness::{FLIGHTS, NOISE, RobustnessResult, shaped_flights};
pub use tuning::tune;
