//! Future samples at which the predictive controllers keep their limits.
//!
//! Dense where a limit is about to be met, sparse further out, where it only has to be foreseen: a long
//! flight must begin to brake before the limits are near.

use alloc::vec::Vec;

/// Of the attitude controller about roll and pitch: sixteen of 0.96 s, each gap a third longer than the one before. Turning
/// upside down at the angular acceleration that the paper's airframe has in hover takes 1.2 s. Those about yaw are as many
/// times later as yaw is slower.
pub static ATTITUDE: &[usize] = &[0, 1, 2, 3, 4, 6, 8, 11, 15, 20, 26, 34, 44, 57, 74, 96];

/// Time between the samples that the position and altitude controllers count, s.
pub(crate) const TRANSLATION_SAMPLE_S: f64 = 0.05;

/// The same instants in slower samples: between sparse ones a limit is not kept. Faster samples keep their numbers.
pub(crate) fn in_time(samples: &[usize], sample_time_s: f64) -> Vec<usize> {
    let mut slower: Vec<usize> = samples.iter().map(|sample| one_in_time(*sample, sample_time_s)).collect();
    slower.dedup();
    slower
}

/// The same of one of them.
pub(crate) fn one_in_time(sample: usize, sample_time_s: f64) -> usize {
    let share = (TRANSLATION_SAMPLE_S / sample_time_s).min(1.0);
    // What is measured now cannot be chosen.
    (libm::round(sample as f64 * share) as usize).max(sample.min(1))
}

#[cfg(test)]
mod tests {
    use super::{TRANSLATION_SAMPLE_S, in_time};

    /// The instants of slower samples are those of the usual ones, as far as there are samples; the state of now is not limited.
    #[test]
    fn slower_samples_are_limited_at_the_same_instants() {
        let counted = [1, 2, 3, 4, 5, 8, 13, 20];
        assert_eq!(in_time(&counted, TRANSLATION_SAMPLE_S), counted);
        assert_eq!(in_time(&counted, 0.02), counted);
        assert_eq!(in_time(&counted, 0.2), [1, 2, 3, 5]);
        assert_eq!(in_time(&[0, 1, 2, 28], 0.2), [0, 1, 7]);
    }
}
