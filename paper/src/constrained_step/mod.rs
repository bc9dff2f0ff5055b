//! The claim in numbers: steps under limits, what a few Laguerre coefficients cost there, and how long a sample takes.
//!
//! ```text
//! axis ─┬─► optimum (one program over the whole step, Clarabel) ─┐
//!       └─► controllers ─► flight ───────────────────────────────┴─► cost (closed_loop_cost[])
//!           clarabel_moves ┘                                     └─► trade_off (over N, a, α, placing)
//! ```

pub mod axis;
mod clarabel_moves;
mod controllers;
mod cost;
mod cost_result;
mod flight;
mod optimum;
mod trade_off;

pub use axis::AXES;
pub use cost::{closed_loop_cost, closed_loop_cost_parts};
pub use cost_result::CostResult;
pub use trade_off::{
    ALPHAS, ExcessCost, LAST, PLACED_TERMS, SCALES, TERMS, TradeOff, trade_off, trade_off_parts,
};
