//! The events interface of PX4: what happens, sent reliably with numbers that clients have the words of, and a report of health and
//! arming checks.
//!
//! ```text
//!  vehicle ─► report, failsafes, arming ─► buffer ─► EVENT to everyone
//!                                            ▲  └──► CURRENT_EVENT_SEQUENCE every three seconds
//!                       REQUEST_EVENT ───────┘  ───► EVENT again, or RESPONSE_EVENT_ERROR
//! ```

mod buffer;
mod protocol;
mod report;

pub use protocol::Events;
