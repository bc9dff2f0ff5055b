//! Signing of MAVLink 2: messages without a valid signature are ignored.
//!
//! ```text
//!  key file (0600) ──► SecretKey ─┐
//!  timestamps beside it ─► Kept ──┴─► Signing ──► links: every frame in and out
//!                          ▲                │
//!                          └── KeyFile ◄────┘  before anything that was accepted takes effect
//! ```
//!
//! [`Signing`] decides, and owns neither file nor clock; [`KeyFile`] keeps; `fleet/` brings them together.

mod guard;
mod kept;
mod key;
mod key_file;
mod streams;

pub use guard::{Counts, MOST_AHEAD, Refusal, Signing};
pub use kept::{Kept, Stream};
pub use key::SecretKey;
pub use key_file::KeyFile;
#[cfg(test)]
pub(crate) use streams::{MOST_STREAMS, NEW_STREAM_BEHIND};

/// Seconds from 1970 to 2015, where timestamps begin.
const EPOCH_UNIX_S: u64 = 1_420_070_400;

/// The timestamp of a moment, µs since 1970: units of 10 µs since 2015.
pub fn timestamp(unix_us: u64) -> u64 {
    unix_us.saturating_sub(EPOCH_UNIX_S * 1_000_000) / 10
}
