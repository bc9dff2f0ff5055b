//! Numbers of about 32 digits as unevaluated sums of two doubles (Dekker 1971), as a reference.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A sum of two doubles, the second of which is below the rounding of the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoubleDouble(f64, f64);

impl DoubleDouble {
    pub fn new(value: f64) -> Self {
        Self(value, 0.0)
    }

    pub fn value(self) -> f64 {
        self.0
    }

    pub fn sqrt(self) -> Self {
        // One Newton step doubles the digits.
        let root = Self::new(self.0.sqrt());
        root + (self - root * root) / (root + root)
    }

    fn normalised(high: f64, low: f64) -> Self {
        let sum = high + low;
        Self(sum, low - (sum - high))
    }
}

impl Add for DoubleDouble {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let sum = self.0 + other.0;
        let part = sum - self.0;
        let error = (self.0 - (sum - part)) + (other.0 - part);
        Self::normalised(sum, error + self.1 + other.1)
    }
}

impl Neg for DoubleDouble {
    type Output = Self;

    fn neg(self) -> Self {
        Self(-self.0, -self.1)
    }
}

impl Sub for DoubleDouble {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for DoubleDouble {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let product = self.0 * other.0;
        let error = self.0.mul_add(other.0, -product);
        Self::normalised(product, error + self.0 * other.1 + self.1 * other.0)
    }
}

impl Div for DoubleDouble {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let first = Self::new(self.0 / other.0);
        let rest = self - first * other;
        first + Self::new(rest.0 / other.0)
    }
}
