//! The noise of a signal that is set every so often.

use serde::{Deserialize, Serialize};

/// So many fits count.
const FITS: usize = 16;
/// The mean square over the median of the squares of three normal deviates: 3 over the median of χ²₃.
const MEAN_OF_MEDIAN: f64 = 1.268;

/// What polynomials through a signal leave, over many of them: one alone leaves next to nothing by chance.
///
/// It is a median: the corners of a signal, of which a few fits leave much, do not count as noise, and a few rounded samples that happen
/// to lie on a polynomial do not count as exact.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct SignalNoise {
    /// What the latest fits left; the oldest is replaced next.
    left: [f64; FITS],
    /// How many were seen, and then counted from [`FITS`] on again.
    fits: usize,
    variance: f64,
}

impl SignalNoise {
    /// A polynomial left a variance.
    pub fn observe(&mut self, variance: f64) {
        if let Some(left) = self.left.get_mut(self.fits % FITS) {
            *left = variance;
        }
        self.fits = if self.fits + 1 < 2 * FITS { self.fits + 1 } else { FITS };
        let mut sorted = self.left;
        let seen = sorted.get_mut(..self.fits.min(FITS)).unwrap_or_default();
        seen.sort_unstable_by(f64::total_cmp);
        let [below, above] =
            [seen.len() - 1, seen.len()].map(|twice| seen.get(twice / 2).copied().unwrap_or_default());
        self.variance = MEAN_OF_MEDIAN * (below + above) / 2.0;
    }

    /// Variance of the signal; 0 if nothing is known.
    pub fn variance(&self) -> f64 {
        self.variance
    }
}

#[cfg(test)]
mod tests {
    use super::SignalNoise;

    /// Squares of deviates in three axes as tables of χ² have them, times a variance of 4.
    #[test]
    fn the_variance_of_normal_deviates_is_found() {
        // Quantiles of χ²₃ at (k + ½)/16, divided by 3.
        let quantiles = [
            0.0841, 0.1856, 0.2746, 0.3609, 0.4479, 0.538, 0.6328, 0.7345, 0.8455, 0.9689, 1.1094, 1.2743,
            1.4762, 1.7406, 2.1329, 2.9524,
        ];
        let mut noise = SignalNoise::default();
        for quantile in quantiles {
            noise.observe(4.0 * quantile);
        }
        assert!((noise.variance() - 4.0).abs() < 0.4, "{}", noise.variance());
    }

    /// Two corners in sixteen fits of an exact signal.
    #[test]
    fn corners_are_no_noise() {
        let mut noise = SignalNoise::default();
        for fit in 0..64 {
            noise.observe(if fit % 16 < 2 { 1.0 } else { 1e-28 });
        }
        assert!(noise.variance() < 1e-20, "{}", noise.variance());
    }
}
