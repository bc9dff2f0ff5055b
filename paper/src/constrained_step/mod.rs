//! The claim in numbers: steps under limits, what a few Laguerre coefficients cost there, and how long a sample takes.
//!
//! ```text
//! axis ─┬─► optimum (one program over the whole step, Clarabel) ─┐
//!       └─► controllers ─► flight ───────────────────────────────┴─► cost (closed_loop_cost[])
//!           clarabel_moves ┘                                     └─► trade_off (over N, a, α, placing)
//! ```

mod axis;
mod clarabel_moves;
mod controllers;
mod cost;
mod flight;
mod optimum;
mod trade_off;
mod two_axes;

pub use axis::Axis;
pub use clarabel_moves::ClarabelMoves;
pub use controllers::{Controller, Placing, laguerre, state_space};
pub use cost::{CostResult, closed_loop_cost};
pub use flight::{Flown, fly};
pub use optimum::optimum;
pub use trade_off::{ExcessCost, TradeOff, trade_off};
