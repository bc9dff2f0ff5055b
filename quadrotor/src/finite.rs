//! Whether numbers are finite.

/// Whether all of them are. All are looked at, without a branch for each: that is quicker.
pub(crate) fn are_finite(numbers: &[f64]) -> bool {
    numbers.iter().fold(true, |all, number| all & number.is_finite())
}
