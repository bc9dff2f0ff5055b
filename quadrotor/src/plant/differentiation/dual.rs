//! Numbers with a derivative.

use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use num_traits::{One, Zero};

use super::real::{Real, Valued};

/// A dual number a + b ε with ε² = 0: a value, and its derivative along one direction. Calculating with it is forward-mode
/// differentiation, exact up to rounding (Griewank, Walther 2008, "Evaluating derivatives", chapter 3).
///
/// The crate has its own because the known one, num-dual, needs the standard library and with it other elementary functions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual {
    /// a.
    pub value: f64,
    /// b, the derivative.
    pub tangent: f64,
}

impl Dual {
    /// `value`, that changes by `tangent`.
    pub fn new(value: f64, tangent: f64) -> Self {
        Self { value, tangent }
    }

    /// g(a) + g′(a) b ε. Where nothing changes, nothing follows, whatever the slope.
    fn chain(self, value: f64, slope: impl FnOnce() -> f64) -> Self {
        let tangent = if self.tangent == 0.0 { 0.0 } else { slope() * self.tangent };
        Self { value, tangent }
    }
}

impl Zero for Dual {
    fn zero() -> Self {
        Self::new(0.0, 0.0)
    }

    fn is_zero(&self) -> bool {
        *self == Self::zero()
    }
}

impl One for Dual {
    fn one() -> Self {
        Self::new(1.0, 0.0)
    }
}

impl Neg for Dual {
    type Output = Self;

    fn neg(self) -> Self {
        Self::new(-self.value, -self.tangent)
    }
}

impl Add for Dual {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::new(self.value + other.value, self.tangent + other.tangent)
    }
}

impl Sub for Dual {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self::new(self.value - other.value, self.tangent - other.tangent)
    }
}

impl Mul for Dual {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self::new(self.value * other.value, self.value * other.tangent + self.tangent * other.value)
    }
}

impl Div for Dual {
    type Output = Self;

    /// (a/b)′ = (a′ − (a/b) b′)/b
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        Self::new(value, (self.tangent - value * other.tangent) / other.value)
    }
}

impl Add<f64> for Dual {
    type Output = Self;

    fn add(self, constant: f64) -> Self {
        Self::new(self.value + constant, self.tangent)
    }
}

impl Sub<f64> for Dual {
    type Output = Self;

    fn sub(self, constant: f64) -> Self {
        Self::new(self.value - constant, self.tangent)
    }
}

impl Mul<f64> for Dual {
    type Output = Self;

    fn mul(self, constant: f64) -> Self {
        Self::new(self.value * constant, self.tangent * constant)
    }
}

impl Div<f64> for Dual {
    type Output = Self;

    fn div(self, constant: f64) -> Self {
        Self::new(self.value / constant, self.tangent / constant)
    }
}

impl AddAssign for Dual {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Dual {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl MulAssign for Dual {
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl DivAssign for Dual {
    fn div_assign(&mut self, other: Self) {
        *self = *self / other;
    }
}

impl Real for Dual {
    fn constant(value: f64) -> Self {
        Self::new(value, 0.0)
    }

    fn where_greater(self, bound: Self, then: Self, otherwise: Self) -> Self {
        if self.value > bound.value { then } else { otherwise }
    }

    fn sqrt(self) -> Self {
        let root = libm::sqrt(self.value);
        self.chain(root, || 0.5 / root)
    }

    fn abs(self) -> Self {
        if self.value < 0.0 { -self } else { Self::new(libm::fabs(self.value), self.tangent) }
    }

    fn hypot(self, other: Self) -> Self {
        let length = libm::hypot(self.value, other.value);
        if length == 0.0 {
            return Self::constant(0.0);
        }
        Self::new(length, (self.value * self.tangent + other.value * other.tangent) / length)
    }
}

impl Valued for Dual {
    fn value(self) -> f64 {
        self.value
    }

    fn cos(self) -> Self {
        self.chain(libm::cos(self.value), || -libm::sin(self.value))
    }

    fn asin(self) -> Self {
        self.chain(libm::asin(self.value), || 1.0 / libm::sqrt((1.0 - self.value) * (1.0 + self.value)))
    }

    fn atan2(self, x: Self) -> Self {
        let (y, squared) = (self, self.value * self.value + x.value * x.value);
        let value = libm::atan2(y.value, x.value);
        let turned = x.value * y.tangent - y.value * x.tangent;
        // Where nothing turns, nothing follows, at the origin either.
        Self::new(value, if turned == 0.0 { 0.0 } else { turned / squared })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{Dual, Real, Valued};

    /// Slope of g at x by central differences, of fourth order.
    fn slope(g: impl Fn(f64) -> f64, x: f64) -> f64 {
        let central = |h: f64| (g(x + h) - g(x - h)) / (2.0 * h);
        (4.0 * central(5e-4) - central(1e-3)) / 3.0
    }

    fn assert_slope(name: &str, g: impl Fn(Dual) -> Dual, x: f64) {
        let found = g(Dual::new(x, 1.0));
        let plain = |x: f64| g(Dual::constant(x)).value;
        assert_eq!(found.value.to_bits(), plain(x).to_bits(), "{name}");
        let expected = slope(plain, x);
        assert!(
            (found.tangent - expected).abs() < 1e-8 * (1.0 + expected.abs()),
            "{name} at {x}: {found:?}, {expected}"
        );
    }

    proptest! {
        #[test]
        fn operations_have_the_slopes_of_differences(x in 0.2..0.8, a in 0.3..3.0, b in -2.0..2.0) {
            let (c, d) = (Dual::new(a, b), Dual::constant(a));
            // What c contributes: g(x + ε, a + b ε) has the slope g_x + b g_a.
            assert_slope("product", |x| x * d + d * x * x, x);
            assert_slope("quotient", |x| d / x - x / d, x);
            assert_slope("constants", |x| (x * a + b - a) / a - b, x);
            assert_slope("square root", |x| (x + d).sqrt(), x);
            assert_slope("modulus", |x| (x - d).abs(), x - 1.0);
            assert_slope("hypotenuse", |x| x.hypot(d) + d.hypot(x - a), x);
            assert_slope("cosine", |x| (x * b).cos(), x);
            assert_slope("arc sine", |x| (x * -1.0).asin(), x);
            assert_slope("angle", |x| (-x).atan2(d * b) + d.atan2(x), x);
            assert_slope("assignments", |x| { let mut y = x; y *= x; y += d; y /= x; y -= x; y }, x);
            prop_assert_eq!((c * d).tangent, b * a);
        }
    }

    #[test]
    fn where_nothing_changes_nothing_follows() {
        let [zero, one] = [0.0, 1.0].map(Dual::constant);
        for number in [zero.sqrt(), one.asin(), zero.hypot(zero), zero.atan2(zero)] {
            assert_eq!(number.tangent, 0.0);
        }
        assert_eq!(Dual::new(0.0, 2.0).abs(), Dual::new(0.0, 2.0));
    }

    #[test]
    fn a_bound_does_not_change() {
        assert_eq!(Dual::new(2.0, 3.0).at_least(1.0), Dual::new(2.0, 3.0));
        assert_eq!(Dual::new(1.0, 3.0).at_least(1.0), Dual::constant(1.0));
    }
}
