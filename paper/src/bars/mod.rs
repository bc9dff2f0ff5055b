//! What the closed loop is measured by: flights on the nonlinear plant, with a bar for each of their figures.
//!
//! ```text
//! taylor ─► path ─► plan ◄─ plans (all flights)
//!                    │
//! geometric, flyer ──┴─► flight ─► track ─► measures ─► figure ─┐
//! robustness ──────────────────────────────────────────► random ─┼─► result ─► bars[]
//! sample_time ───────────────────────────────────────────────────┘
//! optimum ─► optimum[], for three of the flights
//! ```

mod figure;
mod flight;
mod flyer;
mod geometric;
mod measures;
mod optimum;
mod path;
mod plan;
mod plans;
mod random;
mod result;
mod sample_time;
mod table;
mod taylor;
mod track;

pub use figure::{EXCESS, SETTLED, SQUARED_DISTANCE};
pub use flight::{Lost, fly};
pub use flyer::Flyer;
pub use measures::{largest, rms};
pub use optimum::{Optimum, OptimumResult};
pub use path::{Path, Shape};
pub use plan::{Demand, Plan, Points, Pushes, Row};
pub use plans::plans;
pub use random::judged as judged_random_flights;
pub use result::{BarResult, flown};
pub use sample_time::sample_times;
pub use table::{Bars, ShownFlight, bars, bars_parts};
pub use track::{Moment, Track};
