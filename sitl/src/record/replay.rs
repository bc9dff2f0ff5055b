//! Flying a record again.

use std::path::Path;

use super::{Digest, Entry, read};
use crate::autopilot::Autopilot;
use crate::failure::Failure;
use crate::vehicle::TICK_US;

/// A flight that was flown again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Replayed {
    /// Its length, µs.
    pub time_us: u64,
    /// Its digest, which is the recorded one.
    pub digest: u64,
}

/// Flies a record again, as fast as possible, and compares the flights.
///
/// # Errors
/// [`Failure::Differs`] when they differ; [`Failure`] when the file is no record.
pub fn replay(path: &Path) -> Result<Replayed, Failure> {
    let (header, entries) = read(path)?;
    let mut autopilot = Autopilot::new(&header.vehicle, header.system_id, header.speed, &header.links, 0)?;
    let mut digest = Digest::default();
    for entry in entries {
        let (Entry::Frame { time_us, .. } | Entry::End { time_us, .. }) = &entry;
        while autopilot.vehicle().time_us() + TICK_US <= *time_us {
            autopilot.tick()?;
            digest.update(autopilot.vehicle());
            drop(autopilot.take_outgoing());
        }
        match entry {
            Entry::Frame { origin, frame, .. } => autopilot.receive(&origin, &frame),
            Entry::End { digest: recorded, time_us } => {
                let replayed = digest.value();
                if replayed != recorded {
                    return Err(Failure::Differs { recorded, replayed });
                }
                return Ok(Replayed { time_us, digest: replayed });
            }
        }
    }
    Err(Failure::Content { path: path.to_owned(), reason: "the record has no end".to_owned() })
}
