//! What a person sees: the banner, the panel, the log.
//!
//! ```text
//! fleet ─► status (rows of segments) ─► panel (when, how much) ─┬─► live ─► standard error
//!                                       log ────────────────────┘
//! ```

mod banner;
mod live;
mod log;
mod panel;
mod screen;
mod segment;
mod status;

pub use banner::{banner, hil_banner};
pub use log::{aside, set_simulation_time, start_log};
pub use panel::Panel;
pub use status::{of_autopilot, of_fleet, waiting};
