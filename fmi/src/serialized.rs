//! A saved state as bytes: header, then the payload.
//!
//! | bytes | content, little-endian |
//! | --- | --- |
//! | 8 | magic of the model |
//! | 4 | version of the model's format |
//! | 16 | identity of the interface, as in the GUID |
//! | 8 | length of the payload |
//! | 4 | CRC-32 of the payload |
//! | … | payload: [`Snapshot`] in postcard |

use crc::{CRC_32_ISO_HDLC, Crc};

use crate::error::{CallError, SavedStateError};
use crate::identity::identity;
use crate::model::Model;
use crate::snapshot::Snapshot;

const HEADER: usize = 8 + 4 + 16 + 8 + 4;
/// With a table of 1 kB: the library is small.
static CHECKSUM: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// The bytes of a state.
pub(crate) fn serialize<M: Model>(snapshot: &Snapshot<M>) -> Result<Vec<u8>, CallError> {
    let payload = postcard::to_allocvec(snapshot).map_err(|_| SavedStateError::Undecodable)?;
    let mut bytes = Vec::with_capacity(HEADER + payload.len());
    bytes.extend_from_slice(&M::IDENTITY.saved_state.magic);
    bytes.extend_from_slice(&M::IDENTITY.saved_state.version.to_le_bytes());
    bytes.extend_from_slice(&identity::<M>().to_le_bytes());
    bytes.extend_from_slice(&(payload.len() as u64).to_le_bytes());
    bytes.extend_from_slice(&CHECKSUM.checksum(&payload).to_le_bytes());
    bytes.extend_from_slice(&payload);
    Ok(bytes)
}

/// The state in `bytes`, checked.
pub(crate) fn deserialize<M: Model>(bytes: &[u8]) -> Result<Snapshot<M>, CallError> {
    let snapshot = decode::<M>(bytes)?;
    snapshot.check()?;
    Ok(snapshot)
}

fn decode<M: Model>(bytes: &[u8]) -> Result<Snapshot<M>, SavedStateError> {
    let expected = M::IDENTITY.saved_state;
    let no_header = SavedStateError::NoHeader { size: bytes.len() };
    let Some((header, payload)) = bytes.split_first_chunk::<HEADER>() else { return Err(no_header) };
    let mut fields = header.as_slice();
    if take::<8>(&mut fields) != expected.magic {
        return Err(no_header);
    }
    let format = u32::from_le_bytes(take(&mut fields));
    if format != expected.version {
        return Err(SavedStateError::Format { found: format, expected: expected.version });
    }
    if u128::from_le_bytes(take(&mut fields)) != identity::<M>() {
        return Err(SavedStateError::OtherModel);
    }
    let length = u64::from_le_bytes(take(&mut fields));
    if length != payload.len() as u64 {
        let expected = usize::try_from(length).unwrap_or(usize::MAX).saturating_add(HEADER);
        return Err(SavedStateError::Length { actual: bytes.len(), expected });
    }
    if u32::from_le_bytes(take(&mut fields)) != CHECKSUM.checksum(payload) {
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
    use super::{HEADER, deserialize, serialize};
    use crate::clock::Clock;
    use crate::error::{CallError, SavedStateError};
    use crate::input_derivative::InputDerivative;
    use crate::lag::Lag;
    use crate::lifecycle::{Kind, Phase};
    use crate::model::Model;
    use crate::snapshot::{Settings, Snapshot};

    fn snapshot() -> Snapshot<Lag> {
        let settings = Settings::default();
        let mut lag = Lag::new(&settings.parameters, &settings.inputs).expect("the defaults are valid");
        lag.advance_to(1_234_567, &|_| settings.inputs.clone()).expect("it goes on");
        let mut clock = Clock::default();
        let end = clock.step(0.0, 1.234_567, 10.0).expect("a legal step");
        clock.advance_to(&end);
        Snapshot {
            kind: Kind::CoSimulation,
            phase: Phase::StepComplete,
            clock,
            settings,
            derivatives: Vec::new(),
            run: Some(lag.state()),
        }
    }

    /// Bytes with a valid header and any payload.
    fn forged(snapshot: &Snapshot<Lag>) -> Result<Snapshot<Lag>, CallError> {
        deserialize(&serialize(snapshot).expect("it serializes"))
    }

    #[test]
    fn round_trip() {
        let snapshot = snapshot();
        assert_eq!(forged(&snapshot), Ok(snapshot));
    }

    #[test]
    fn absurd_content_with_a_good_checksum_is_refused() {
        let refused = |change: fn(&mut Snapshot<Lag>)| {
            let mut snapshot = snapshot();
            change(&mut snapshot);
            assert!(forged(&snapshot).is_err(), "{snapshot:?}");
        };
        refused(|s| s.settings.inputs.u = f64::NAN);
        refused(|s| s.settings.inputs.u = 1e7);
        refused(|s| s.settings.parameters.time_constant_s = 0.0);
        refused(|s| s.settings.parameters.limit = -1.0);
        refused(|s| s.derivatives.push(InputDerivative { reference: 0, order: 9, value: 1.0 }));
        refused(|s| s.derivatives.push(InputDerivative { reference: 99, order: 1, value: 1.0 }));
        refused(|s| s.clock = Clock::default());
        refused(|s| s.run = None);
        refused(|s| s.phase = Phase::Fatal);
    }

    #[test]
    fn trailing_bytes_in_the_payload_are_refused() {
        let mut bytes = serialize(&snapshot()).expect("it serializes");
        bytes.push(0);
        let payload = &bytes[HEADER..];
        let (length, checksum) = (payload.len() as u64, crc32fast::hash(payload));
        bytes[28..36].copy_from_slice(&length.to_le_bytes());
        bytes[36..40].copy_from_slice(&checksum.to_le_bytes());
        assert_eq!(deserialize::<Lag>(&bytes), Err(CallError::SavedState(SavedStateError::Undecodable)));
    }
}
