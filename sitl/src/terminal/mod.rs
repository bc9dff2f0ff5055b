//! What a person sees: the banner, the status line, the log.

mod banner;
mod log;
mod screen;
mod status;
mod status_line;

pub use banner::{banner, hil_banner};
pub use log::{set_simulation_time, start_log};
pub use status::{of_autopilot, of_fleet};
pub use status_line::{Segment, StatusLine};
