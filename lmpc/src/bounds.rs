//! Right-hand sides of the constraints of a quadratic program.

/// h of G x ≤ h, row by row.
pub(crate) trait Bounds {
    /// What bounds a row; infinity is no bound.
    fn bound(&self, row: usize) -> f64;

    /// The size of what the bound is the sum of, which its rounding is relative to. Asked for when a row is exceeded.
    fn size(&self, row: usize) -> f64;
}

/// Bounds as they are given; missing ones do not bound.
pub(crate) struct GivenBounds<'a>(pub(crate) &'a [f64]);

impl Bounds for GivenBounds<'_> {
    fn bound(&self, row: usize) -> f64 {
        self.0.get(row).copied().unwrap_or(f64::INFINITY)
    }

    fn size(&self, row: usize) -> f64 {
        libm::fabs(self.bound(row))
    }
}
