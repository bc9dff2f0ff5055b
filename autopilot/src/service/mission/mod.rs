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
mod guided_item;
mod progress;
mod protocol;
mod reservation;
mod upload;

pub use protocol::Missions;
