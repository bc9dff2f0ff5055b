//! Right-hand sides of the constraints of a quadratic program.

use crate::Precision;

/// h of G x ≤ h, row by row.
pub(crate) trait Bounds<T> {
    /// What bounds a row; infinity is no bound.
    fn bound(&self, row: usize) -> T;

    /// The size of what the bound is the sum of, which its rounding is relative to. Asked for when a row is exceeded.
    fn size(&self, row: usize) -> T;
}

/// Bounds as they are given; missing ones do not bound.
pub(crate) struct GivenBounds<'a, T>(pub(crate) &'a [T]);

impl<T: Precision> Bounds<T> for GivenBounds<'_, T> {
    fn bound(&self, row: usize) -> T {
        self.0.get(row).copied().unwrap_or(T::INFINITY)
    }

    fn size(&self, row: usize) -> T {
        self.bound(row).abs()
    }
}
