//! The numbers that a control step calculates with.

use core::iter::Sum;

use nalgebra::{RealField, SMatrix};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Numbers that a control step calculates with: `f64`, in which everything is designed and which is the default of every type here, or
/// `f32`, for processors that have nothing else in hardware.
///
/// Design a controller in `f64`, then convert it by its `to_precision`. The tolerances follow the precision; each is relative to the
/// numbers that it judges.
pub trait Precision:
    RealField + Copy + Default + Sum + Serialize + DeserializeOwned + sealed::Sealed
{
    /// No bound.
    const INFINITY: Self;
    /// The smallest number above zero by which others are divided.
    const SMALLEST: Self;
    /// How far beyond its bound a limit of predicted signals counts as met.
    const LIMIT: Self;
    /// The same for a constraint of a quadratic program alone, whose numbers count as exact.
    const CONSTRAINT: Self;
    /// A unit normal depends on the active normals if removing them leaves less than this share of it.
    const DEPENDENT: Self;
    /// How far the steps of a search may miss the point that they lead to before the search checks that it keeps all constraints: less
    /// than the rounding that the least tolerant programs allow.
    const STEPS: Self;
    /// Difference between a requested and an applied input that the actuators' own arithmetic may cause.
    const ACTUATORS: Self;

    /// The number nearest to a double.
    fn of(value: f64) -> Self;

    /// The double of the same value.
    fn to_f64(self) -> f64;

    /// Whether it is not a number.
    fn is_nan(self) -> bool;
}

impl Precision for f64 {
    const INFINITY: Self = Self::INFINITY;
    const SMALLEST: Self = Self::MIN_POSITIVE;
    const LIMIT: Self = 1e-9;
    const CONSTRAINT: Self = 1e-12;
    const DEPENDENT: Self = 1e-7;
    const STEPS: Self = 1e-13;
    const ACTUATORS: Self = 1e-9;

    #[inline]
    fn of(value: f64) -> Self {
        value
    }

    #[inline]
    fn to_f64(self) -> f64 {
        self
    }

    #[inline]
    fn is_nan(self) -> bool {
        self.is_nan()
    }
}

/// Of seven decimal digits the sums of a step leave five.
impl Precision for f32 {
    const INFINITY: Self = Self::INFINITY;
    const SMALLEST: Self = Self::MIN_POSITIVE;
    const LIMIT: Self = 1e-5;
    const CONSTRAINT: Self = 1e-5;
    const DEPENDENT: Self = 1e-3;
    const STEPS: Self = 1e-6;
    const ACTUATORS: Self = 1e-5;

    #[inline]
    fn of(value: f64) -> Self {
        value as Self
    }

    #[inline]
    fn to_f64(self) -> f64 {
        f64::from(self)
    }

    #[inline]
    fn is_nan(self) -> bool {
        self.is_nan()
    }
}

mod sealed {
    /// Tolerances are known of these alone.
    pub trait Sealed {}

    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

/// The same matrix in another precision.
pub(crate) fn converted<T: Precision, U: Precision, const R: usize, const C: usize>(
    matrix: &SMatrix<T, R, C>,
) -> SMatrix<U, R, C> {
    matrix.map(|value| U::of(value.to_f64()))
}
