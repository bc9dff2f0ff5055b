//! A number that two flights share only if they are the same, bit for bit.

use postcard::ser_flavors::Flavor;
use serde::Serialize;
use vehicle::Vehicle;

/// How often the state is taken in, µs.
const PERIOD_US: u64 = 100_000;

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
        // The state is large: it is copied only when it counts.
        if !is_due(time_us) {
            return;
        }
        self.update_with(time_us, &vehicle.simulation().state());
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
        self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
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
        self.bytes(bytes);
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
}
