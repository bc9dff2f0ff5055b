//! A saved state as bytes: header, then the payload.
//!
//! | bytes | content, little-endian |
//! | --- | --- |
//! | 8 | magic |
//! | 4 | version of the format |
//! | 16 | identity of the interface, as in the GUID |
//! | 8 | length of the payload |
//! | 4 | CRC-32 of the payload |
//! | … | payload: [`Snapshot`] in postcard |

use crate::error::{CallError, SavedStateError};
use crate::guid::{STATE_FORMAT, identity};
use crate::snapshot::Snapshot;

const MAGIC: [u8; 8] = *b"LMPCQRST";
const HEADER: usize = 8 + 4 + 16 + 8 + 4;

/// The bytes of a state.
pub(crate) fn serialize(snapshot: &Snapshot) -> Result<Vec<u8>, CallError> {
    let payload = postcard::to_allocvec(snapshot).map_err(|_| SavedStateError::Undecodable)?;
    let mut bytes = Vec::with_capacity(HEADER + payload.len());
    bytes.extend_from_slice(&MAGIC);
    bytes.extend_from_slice(&STATE_FORMAT.to_le_bytes());
    bytes.extend_from_slice(&identity().to_le_bytes());
    bytes.extend_from_slice(&(payload.len() as u64).to_le_bytes());
    bytes.extend_from_slice(&crc32fast::hash(&payload).to_le_bytes());
    bytes.extend_from_slice(&payload);
    Ok(bytes)
}

/// The state in `bytes`, checked.
pub(crate) fn deserialize(bytes: &[u8]) -> Result<Snapshot, CallError> {
    let snapshot = decode(bytes)?;
    snapshot.check()?;
    Ok(snapshot)
}

fn decode(bytes: &[u8]) -> Result<Snapshot, SavedStateError> {
    let no_header = SavedStateError::NoHeader { size: bytes.len() };
    let Some((header, payload)) = bytes.split_first_chunk::<HEADER>() else { return Err(no_header) };
    let mut fields = header.as_slice();
    if take::<8>(&mut fields) != MAGIC {
        return Err(no_header);
    }
    let format = u32::from_le_bytes(take(&mut fields));
    if format != STATE_FORMAT {
        return Err(SavedStateError::Format { found: format, expected: STATE_FORMAT });
    }
    if u128::from_le_bytes(take(&mut fields)) != identity() {
        return Err(SavedStateError::OtherModel);
    }
    let length = u64::from_le_bytes(take(&mut fields));
    if length != payload.len() as u64 {
        let expected = usize::try_from(length).unwrap_or(usize::MAX).saturating_add(HEADER);
        return Err(SavedStateError::Length { actual: bytes.len(), expected });
    }
    if u32::from_le_bytes(take(&mut fields)) != crc32fast::hash(payload) {
        return Err(SavedStateError::Checksum);
    }
    match postcard::take_from_bytes(payload) {
        Ok((snapshot, [])) => Ok(snapshot),
        _ => Err(SavedStateError::Undecodable),
    }
}

/// The next N bytes of the header, which has them.
fn take<const N: usize>(fields: &mut &[u8]) -> [u8; N] {
    fields.split_off(..N).and_then(|field| field.try_into().ok()).unwrap_or([0; N])
}

#[cfg(test)]
mod tests {
    use quadrotor::Simulation;

    use super::{HEADER, deserialize, serialize};
    use crate::clock::Clock;
    use crate::error::{CallError, SavedStateError};
    use crate::lifecycle::State;
    use crate::snapshot::{Settings, Snapshot};

    fn snapshot() -> Snapshot {
        let settings = Settings::default();
        let mut simulation =
            Simulation::new(&settings.configuration, &settings.inputs).expect("the defaults are valid");
        simulation.advance_to(1_234_567, &settings.inputs).expect("it flies");
        let mut clock = Clock::default();
        let end = clock.step(0.0, 1.234_567).expect("a legal step");
        clock.advance_to(&end);
        Snapshot {
            state: State::StepComplete,
            clock,
            settings,
            derivatives: Vec::new(),
            simulation: Some(simulation.state()),
        }
    }

    /// Bytes with a header that fits, whatever the payload says.
    fn forged(snapshot: &Snapshot) -> Result<Snapshot, CallError> {
        deserialize(&serialize(snapshot).expect("it serializes"))
    }

    #[test]
    fn round_trip() {
        let snapshot = snapshot();
        assert_eq!(forged(&snapshot), Ok(snapshot));
    }

    #[test]
    fn absurd_content_with_a_good_checksum_is_refused() {
        let refused = |change: fn(&mut Snapshot)| {
            let mut snapshot = snapshot();
            change(&mut snapshot);
            assert!(forged(&snapshot).is_err(), "{snapshot:?}");
        };
        refused(|s| s.settings.inputs.reference.position_m.x = f64::NAN);
        refused(|s| s.settings.inputs.reference.position_m.x = 1e7);
        refused(|s| s.settings.configuration.airframe.mass_kg = 0.0);
        refused(|s| s.settings.configuration.controllers.altitude.terms = 1_000_000);
        refused(|s| s.settings.configuration.limits.thrust_min = 20.0);
        refused(|s| s.clock = Clock::default());
        refused(|s| s.simulation = None);
        refused(|s| s.state = State::Fatal);
    }

    #[test]
    fn trailing_bytes_in_the_payload_are_refused() {
        let mut bytes = serialize(&snapshot()).expect("it serializes");
        bytes.push(0);
        let payload = &bytes[HEADER..];
        let (length, checksum) = (payload.len() as u64, crc32fast::hash(payload));
        bytes[28..36].copy_from_slice(&length.to_le_bytes());
        bytes[36..40].copy_from_slice(&checksum.to_le_bytes());
        assert_eq!(deserialize(&bytes), Err(CallError::SavedState(SavedStateError::Undecodable)));
    }

    /// Every number of the flight itself, too: NaN in any place of the payload is found.
    #[test]
    fn nan_anywhere_is_refused() {
        let good = serialize(&snapshot()).expect("it serializes");
        let mut found = 0;
        for place in HEADER..good.len() - 8 {
            let mut bytes = good.clone();
            bytes[place..place + 8].copy_from_slice(&f64::NAN.to_le_bytes());
            let checksum = crc32fast::hash(&bytes[HEADER..]);
            bytes[36..40].copy_from_slice(&checksum.to_le_bytes());
            match deserialize(&bytes) {
                Err(CallError::SavedState(SavedStateError::NotFinite)) => found += 1,
                // Across the bounds of numbers it makes another number, or nothing that decodes.
                _ => continue,
            }
        }
        assert!(found > 100, "only {found} numbers");
    }
}
