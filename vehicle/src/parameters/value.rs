//! Values of parameters.

/// A parameter's value in the precision in which clients and files have it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// A number.
    Real(f32),
    /// A whole number.
    Integer(i32),
}

impl Value {
    /// As a number.
    pub fn number(self) -> f64 {
        match self {
            Self::Real(value) => f64::from(value),
            Self::Integer(value) => f64::from(value),
        }
    }

    /// The four bytes of its value, the lowest first.
    pub fn bytes(self) -> [u8; 4] {
        match self {
            Self::Real(value) => value.to_le_bytes(),
            Self::Integer(value) => value.to_le_bytes(),
        }
    }
}
