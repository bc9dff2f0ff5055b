//! As far as the changes of an estimate have been answered.

use nalgebra::SVector;

use crate::finite::are_finite;

/// By how much an estimate has surely changed from what was answered of it, which it then is: by what is beyond the noise of the
/// estimate.
///
/// Under noise an estimate grows to its value over some samples, none of whose steps need be sure: what counts is how far it has come.
pub(crate) fn answer<const D: usize>(
    answered: &mut SVector<f64, D>,
    estimate: &SVector<f64, D>,
    unsure: &SVector<f64, D>,
) -> SVector<f64, D> {
    let change = (estimate - *answered).zip_map(unsure, beyond);
    // What leads out of the numbers is not remembered.
    if are_finite(change.as_slice()) {
        *answered += change;
    }
    change
}

/// By how much a change is larger than one that may be noise.
fn beyond(change: f64, unsure: f64) -> f64 {
    // Without panics: a state that tumbles out of the numbers makes bounds that are none.
    change - change.max(-unsure).min(unsure)
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector1;

    use super::{answer, beyond};

    /// Noise, and a sample out of the numbers, after which the next one counts as if it had not been.
    #[test]
    fn what_is_surely_a_change_is_answered_once() {
        let mut answered = Vector1::new(0.0);
        let mut change = |estimate: f64| answer(&mut answered, &Vector1::new(estimate), &Vector1::new(2.0)).x;
        for (estimate, expected) in [(1.5, 0.0), (3.0, 1.0), (5.0, 2.0), (5.0, 0.0), (1.5, 0.0), (0.0, -1.0)]
        {
            assert_eq!(change(estimate), expected, "{estimate}");
        }
        change(f64::NAN);
        assert_eq!(change(5.0), 1.0);
    }

    #[test]
    fn only_what_is_beyond_noise_counts() {
        assert_eq!([3.0, 1.0, -3.0].map(|change| beyond(change, 2.0)), [1.0, 0.0, -1.0]);
        assert_eq!(beyond(3.0, 0.0), 3.0);
        // Out of the numbers, too, it does not panic.
        assert_eq!(beyond(3.0, f64::NAN), 0.0);
    }
}
