//! The mission protocol for missions, fences and rally points: upload, download, partial write, clear.
//!
//! ```text
//!            MISSION_COUNT, MISSION_WRITE_PARTIAL_LIST
//!   idle ──────────────────────────────────────────────► receiving ◄─┐ item n: ask for n + 1
//!    ▲                                                     │  │  │   │ silence: ask for n again
//!    │   last item: the plan is checked and taken over     │  │  └───┘
//!    ├─────────────────────────────────────────────────────┘  │
//!    └────────────────────────────────────────────────────────┘
//!        a fault, a cancellation, too many silences: the old plan stays
//! ```
//!
//! Downloads have no state here: each item is answered when it is asked for, to anybody.

mod answer;
mod download;
mod progress;
mod upload;

pub use download::{request, request_list, request_partial_list};
pub use progress::{current, set_current, set_current_by_command, start, update_progress};
pub use upload::{Uploads, acknowledge, clear_all, count, item, update, write_partial_list};
