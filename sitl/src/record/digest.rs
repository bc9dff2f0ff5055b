//! A number that two flights share only if they are the same, bit for bit.

use postcard::ser_flavors::Flavor;
use serde::Serialize;
use vehicle::Vehicle;

/// How often the state is taken in, µs.
const PERIOD_US: u64 = 100_000;

/// The prime of FNV with 64 bits.
const PRIME: u64 = 0x0100_0000_01b3;

/// FNV-1a with 64 bits over the whole state of the closed loop, and the estimate that it is flown by, ten times per simulated second.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Digest(u64);

impl Default for Digest {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Digest {
    /// Takes the state in, if it is time, and what the vehicle believes if that is something else.
    pub fn update(&mut self, vehicle: &Vehicle) {
        let time_us = vehicle.time_us();
        if !is_due(time_us) {
            return;
        }
        self.update_with(time_us, &vehicle.simulation().state_in_place());
        if let Some(estimate) = vehicle.estimate() {
            self.update_with(time_us, &estimate.body);
        }
    }

    /// The same for anything that has a state and a time, µs.
    pub fn update_with(&mut self, time_us: u64, state: &impl Serialize) {
        if !is_due(time_us) {
            return;
        }
        match postcard::serialize_with_flavor(state, *self) {
            Ok(digest) => *self = digest,
            // It has no kind that cannot be written; an error must not look like sameness.
            Err(error) => tracing::error!(%error, "the state cannot be digested"),
        }
    }

    /// Takes bytes in, whatever the time.
    pub fn bytes(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|byte| self.byte(*byte));
    }

    fn byte(&mut self, byte: u8) {
        self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(PRIME);
    }

    /// Takes the eight bytes of a number in. Each byte waits for the one before it, and most numbers of a state at rest are zero: bytes that
    /// are zero only multiply, which can be done at once.
    fn number(&mut self, bytes: [u8; 8]) {
        if u64::from_le_bytes(bytes) == 0 {
            self.0 = self.0.wrapping_mul(PRIME.wrapping_pow(8));
        } else {
            self.bytes(&bytes);
        }
    }

    /// The number.
    pub fn value(self) -> u64 {
        self.0
    }
}

/// Takes what is serialized in as it comes, without a copy.
impl Flavor for Digest {
    type Output = Self;

    fn try_push(&mut self, byte: u8) -> postcard::Result<()> {
        self.byte(byte);
        Ok(())
    }

    /// A number at once: there are a thousand of them in a state.
    fn try_extend(&mut self, bytes: &[u8]) -> postcard::Result<()> {
        match bytes.try_into() {
            Ok(number) => self.number(number),
            Err(_) => self.bytes(bytes),
        }
        Ok(())
    }

    fn finalize(self) -> postcard::Result<Self> {
        Ok(self)
    }
}

fn is_due(time_us: u64) -> bool {
    time_us.is_multiple_of(PERIOD_US)
}

#[cfg(test)]
mod tests {
    use super::Digest;

    /// Published values of FNV-1a, 64 bits.
    #[test]
    fn it_is_fnv_1a() {
        let of = |text: &str| {
            let mut digest = Digest::default();
            digest.bytes(text.as_bytes());
            digest.value()
        };
        assert_eq!(of(""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(of("a"), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(of("foobar"), 0x8594_4171_f739_67e8);
    }

    #[test]
    fn numbers_count_as_their_bytes() {
        for number in [0, 1, 1 << 63, u64::MAX, (0.1_f64).to_bits()] {
            let (mut at_once, mut by_bytes) = (Digest::default(), Digest::default());
            at_once.number(number.to_le_bytes());
            number.to_le_bytes().iter().for_each(|byte| by_bytes.byte(*byte));
            assert_eq!(at_once, by_bytes, "{number:x}");
        }
    }
}
