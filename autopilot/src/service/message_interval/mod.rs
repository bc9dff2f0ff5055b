//! Which messages a link gets, and how often.

mod protocol;
mod schedule;

pub use protocol::MessageIntervals;
