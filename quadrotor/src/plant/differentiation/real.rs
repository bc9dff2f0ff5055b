//! What the plant's equations calculate with.

use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use nalgebra::{Scalar, Vector3};
use num_traits::{One, Zero};

/// A real number of the plant's equations: an `f64`, a [`Dual`](crate::Dual), which carries a derivative, or a number of each of
/// several vehicles that fly side by side.
///
/// Constants of the vehicle are `f64`, and mix with any such number. For `f64` all operations are those of nalgebra and libm, so
/// that generic equations give the doubles that plain ones give.
pub trait Real:
    Scalar
    + Copy
    + Zero
    + One
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
{
    /// A number that does not depend on anything.
    fn constant(value: f64) -> Self;

    /// `then` where its value is greater than that of `bound`, `otherwise` elsewhere.
    fn where_greater(self, bound: Self, then: Self, otherwise: Self) -> Self;

    /// √x; the derivative of √0 counts as zero where x does not change.
    fn sqrt(self) -> Self;

    /// |x|; its derivative at zero is that from above.
    fn abs(self) -> Self;

    /// √(x² + y²); its derivative at the origin counts as zero.
    fn hypot(self, other: Self) -> Self;

    /// The larger of the two, the constant where they are equal.
    fn at_least(self, bound: f64) -> Self {
        let bound = Self::constant(bound);
        self.where_greater(bound, self, bound)
    }
}

/// A real number of one vehicle: its value chooses branches.
pub trait Valued: Real {
    /// The number itself, without its derivative.
    fn value(self) -> f64;

    /// cos x.
    fn cos(self) -> Self;

    /// arcsin x.
    fn asin(self) -> Self;

    /// The angle of the point (`x`, self), rad.
    fn atan2(self, x: Self) -> Self;
}

impl Real for f64 {
    fn constant(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn where_greater(self, bound: Self, then: Self, otherwise: Self) -> Self {
        if self > bound { then } else { otherwise }
    }

    fn sqrt(self) -> Self {
        libm::sqrt(self)
    }

    fn abs(self) -> Self {
        libm::fabs(self)
    }

    fn hypot(self, other: Self) -> Self {
        libm::hypot(self, other)
    }
}

impl Valued for f64 {
    fn value(self) -> f64 {
        self
    }

    fn cos(self) -> Self {
        libm::cos(self)
    }

    fn asin(self) -> Self {
        libm::asin(self)
    }

    fn atan2(self, x: Self) -> Self {
        libm::atan2(self, x)
    }
}

/// A vector that does not depend on anything.
pub(crate) fn constant<T: Real>(vector: impl Into<Vector3<f64>>) -> Vector3<T> {
    vector.into().map(T::constant)
}
