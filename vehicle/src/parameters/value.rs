//! Values of parameters, and how they travel in a float.

/// A parameter's value in the precision of the protocol.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// MAV_PARAM_TYPE_REAL32.
    Real(f32),
    /// MAV_PARAM_TYPE_INT32.
    Integer(i32),
}

/// How an integer travels in the float field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// Its bytes (PX4).
    Bytewise,
    /// Its value (ArduPilot).
    Cast,
}

/// MAV_PARAM_TYPE of both.
const UINT8: u8 = 1;
const INT8: u8 = 2;
const UINT16: u8 = 3;
const INT16: u8 = 4;
const UINT32: u8 = 5;
const INT32: u8 = 6;

impl Value {
    /// As a number.
    pub fn number(self) -> f64 {
        match self {
            Self::Real(value) => f64::from(value),
            Self::Integer(value) => f64::from(value),
        }
    }

    /// The four bytes of its value, as the hash takes them.
    pub fn bytes(self) -> [u8; 4] {
        match self {
            Self::Real(value) => value.to_le_bytes(),
            Self::Integer(value) => value.to_le_bytes(),
        }
    }

    /// The float field of PARAM_VALUE.
    pub fn encode(self, encoding: Encoding) -> f32 {
        match (self, encoding) {
            (Self::Integer(value), Encoding::Bytewise) => f32::from_le_bytes(value.to_le_bytes()),
            (Self::Integer(value), Encoding::Cast) => value as f32,
            (Self::Real(value), _) => value,
        }
    }

    /// The number in the float field of PARAM_SET, of the type that its sender says.
    pub fn decode(field: f32, parameter_type: u8, encoding: Encoding) -> f64 {
        let [low, second, ..] = field.to_le_bytes();
        let bits = field.to_bits();
        match (encoding, parameter_type) {
            (Encoding::Bytewise, UINT8) => f64::from(low),
            (Encoding::Bytewise, INT8) => f64::from(low as i8),
            (Encoding::Bytewise, UINT16) => f64::from(u16::from_le_bytes([low, second])),
            (Encoding::Bytewise, INT16) => f64::from(i16::from_le_bytes([low, second])),
            (Encoding::Bytewise, UINT32) => f64::from(bits),
            (Encoding::Bytewise, INT32) => f64::from(bits as i32),
            _ => f64::from(field),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Encoding, Value};

    #[test]
    fn integers_travel_as_bytes_or_as_a_number() {
        for value in [0, 1, -1, 5, 100_000, i32::MAX, i32::MIN] {
            let field = Value::Integer(value).encode(Encoding::Bytewise);
            assert_eq!(Value::decode(field, 6, Encoding::Bytewise), f64::from(value));
        }
        assert_eq!(Value::Integer(-7).encode(Encoding::Cast), -7.0);
        assert_eq!(Value::decode(-7.0, 6, Encoding::Cast), -7.0);
        assert_eq!(Value::decode(f32::from_bits(0xff), 2, Encoding::Bytewise), -1.0);
        // A client that sends every value as a float.
        assert_eq!(Value::decode(3.0, 9, Encoding::Bytewise), 3.0);
    }
}
