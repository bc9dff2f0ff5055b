//! Flying a record again.

use std::path::Path;

use autopilot::Autopilot;
use vehicle::TICK_US;

use super::{Digest, Entry, Header, Participant, read};
use crate::failure::Failure;
use crate::summary::Flight;

/// Flies every vehicle of a record again, each alone and as fast as possible, and compares the flights. Returns them:
/// their digests are the recorded ones.
///
/// # Errors
/// [`Failure::Differs`] when one differs; [`Failure`] when the file is no record.
pub fn replay(path: &Path) -> Result<Vec<Flight>, Failure> {
    let (header, entries) = read(path)?;
    let wrong = |reason: String| Failure::Content { path: path.to_owned(), reason };
    let mut flights: Vec<Vec<Entry>> = header.vehicles.iter().map(|_| Vec::new()).collect();
    for entry in entries {
        let number = entry.vehicle();
        let flight = flights.get_mut(number).ok_or_else(|| wrong(format!("there is no vehicle {number}")))?;
        flight.push(entry);
    }
    let each = header.vehicles.iter().zip(flights);
    each.map(|(participant, entries)| {
        let no_end = || wrong(format!("the flight of system {} has no end", participant.system_id));
        fly(participant, &header, entries)?.ok_or_else(no_end)
    })
    .collect()
}

/// One vehicle's flight; `None` if its end is missing.
fn fly(participant: &Participant, header: &Header, entries: Vec<Entry>) -> Result<Option<Flight>, Failure> {
    let Participant { system_id, links, vehicle } = participant;
    let system_id = *system_id;
    let mut autopilot = Autopilot::new(vehicle, system_id, header.speed, links, header.unix_start_us)?;
    let mut digest = Digest::default();
    for entry in entries {
        while autopilot.vehicle().time_us() + TICK_US <= entry.time_us() {
            autopilot.tick()?;
            digest.update(autopilot.vehicle());
            drop(autopilot.take_outgoing());
        }
        match entry {
            Entry::Frame { origin, frame, .. } => autopilot.receive(&origin, &frame),
            Entry::GroundStation { heard, .. } => autopilot.hear_ground_station(heard),
            Entry::End { digest: recorded, time_us, .. } => {
                let replayed = digest.value();
                if replayed != recorded {
                    return Err(Failure::Differs { system_id, recorded, replayed });
                }
                return Ok(Some(Flight { system_id, time_us, digest: replayed }));
            }
        }
    }
    Ok(None)
}
