//! Values of parameters.

use std::fmt::{self, Display, Formatter};

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

impl Display for Value {
    /// The shortest text that reads back as the same value.
    fn fmt(&self, to: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Real(value) => value.fmt(to),
            Self::Integer(value) => value.fmt(to),
        }
    }
}

/// A number within a range, `None` if it is outside. Clients and files have single precision: what rounds to a bound there is
/// that bound.
pub(super) fn within(minimum: f64, maximum: f64, value: f64) -> Option<f64> {
    let bound = [minimum, maximum].into_iter().find(|bound| *bound as f32 == value as f32);
    // NaN is in no range.
    bound.or_else(|| (minimum..=maximum).contains(&value).then_some(value))
}

#[cfg(test)]
mod tests {
    use super::within;

    #[test]
    fn a_bound_in_single_precision_is_the_bound() {
        assert_eq!(within(0.05, 1.2, f64::from(1.2_f32)), Some(1.2));
        assert!(f64::from(1.2_f32) > 1.2);
        assert_eq!(within(0.0, 0.9, f64::from(0.9_f32)), Some(0.9));
        assert!(f64::from(0.9_f32) < 0.9);
        for outside in [1.200_001, 0.049_99, f64::NAN, f64::INFINITY] {
            assert_eq!(within(0.05, 1.2, outside), None);
        }
    }
}
