//! Values of parameters on the wire: how they travel in a float, and the hash over all of them.

use vehicle::identity::Identity;
use vehicle::parameters::Value;

/// How an integer travels in the float field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// Its bytes (PX4).
    Bytewise,
    /// Its value (ArduPilot).
    Cast,
}

/// MAV_PARAM_TYPE of integers.
const UINT8: u8 = 1;
const INT8: u8 = 2;
const UINT16: u8 = 3;
const INT16: u8 = 4;
const UINT32: u8 = 5;
const INT32: u8 = 6;

impl Encoding {
    /// The one that clients expect of an identity.
    pub fn of(identity: Identity) -> Self {
        if identity.is_ardupilot() { Self::Cast } else { Self::Bytewise }
    }

    /// The float field of PARAM_VALUE.
    pub fn encode(self, value: Value) -> f32 {
        match (value, self) {
            (Value::Integer(value), Self::Bytewise) => f32::from_le_bytes(value.to_le_bytes()),
            (Value::Integer(value), Self::Cast) => value as f32,
            (Value::Real(value), _) => value,
        }
    }

    /// The float field of PARAM_VALUE for a hash.
    pub fn encode_hash(self, hash: u32) -> f32 {
        match self {
            Self::Bytewise => f32::from_bits(hash),
            Self::Cast => hash as f32,
        }
    }

    /// Whether PARAM_SET of a MAV_PARAM_TYPE can change a parameter that has a value. The bytes of an integer are no real value, and PX4
    /// refuses them; ArduPilot converts all types.
    pub fn fits(self, present: Value, parameter_type: u8) -> bool {
        let is_integer = (UINT8..=INT32).contains(&parameter_type);
        self == Self::Cast || !is_integer || matches!(present, Value::Integer(_))
    }

    /// The number in the float field of PARAM_SET, of the MAV_PARAM_TYPE that its sender says.
    pub fn decode(self, field: f32, parameter_type: u8) -> f64 {
        let [low, second, ..] = field.to_le_bytes();
        let bits = field.to_bits();
        match (self, parameter_type) {
            (Self::Bytewise, UINT8) => f64::from(low),
            (Self::Bytewise, INT8) => f64::from(low as i8),
            (Self::Bytewise, UINT16) => f64::from(u16::from_le_bytes([low, second])),
            (Self::Bytewise, INT16) => f64::from(i16::from_le_bytes([low, second])),
            (Self::Bytewise, UINT32) => f64::from(bits),
            (Self::Bytewise, INT32) => f64::from(bits as i32),
            _ => f64::from(field),
        }
    }
}

/// PX4's hash over names and values, in order: CRC-32 (IEEE, reflected) that begins with zero and is not inverted.
pub fn parameter_hash<'a>(parameters: impl IntoIterator<Item = (&'a str, Value)>) -> u32 {
    let mut hasher = crc32fast::Hasher::new_with_initial(u32::MAX);
    for (id, value) in parameters {
        hasher.update(id.as_bytes());
        hasher.update(&value.bytes());
    }
    !hasher.finalize()
}

#[cfg(test)]
mod tests {
    use vehicle::parameters::Value;

    use super::Encoding;

    #[test]
    fn integers_travel_as_bytes_or_as_a_number() {
        for value in [0, 1, -1, 5, 100_000, i32::MAX, i32::MIN] {
            let field = Encoding::Bytewise.encode(Value::Integer(value));
            assert_eq!(Encoding::Bytewise.decode(field, 6), f64::from(value));
        }
        assert_eq!(Encoding::Cast.encode(Value::Integer(-7)), -7.0);
        assert_eq!(Encoding::Cast.decode(-7.0, 6), -7.0);
        assert_eq!(Encoding::Bytewise.decode(f32::from_bits(0xff), 2), -1.0);
        // A client that sends every value as a float.
        assert!(Encoding::Bytewise.fits(Value::Integer(3), 9));
        assert_eq!(Encoding::Bytewise.decode(3.0, 9), 3.0);
    }
}
