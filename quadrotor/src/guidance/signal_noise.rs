//! The noise of a signal that is set every so often.

use serde::{Deserialize, Serialize};

/// So many fits count.
const FITS: u32 = 16;
/// Least variance of which the logarithm is taken.
const LEAST_VARIANCE: f64 = 1e-40;
/// The mean square over the geometric mean of the squares of three normal deviates: 1/(⅔ exp ψ(3/2)).
const MEAN_OF_LOGARITHMS: f64 = 1.45;

/// What polynomials through a signal leave, over many of them: one alone leaves next to nothing by chance.
///
/// It is a geometric mean, so that the corners of a signal, of which a few fits leave much, do not count as noise.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct SignalNoise {
    log_variance: f64,
    /// How many were seen, at most as many as count.
    fits: u32,
}

impl SignalNoise {
    /// A polynomial left a variance.
    pub fn observe(&mut self, variance: f64) {
        self.fits = (self.fits + 1).min(FITS);
        let log_variance = libm::log(variance.max(LEAST_VARIANCE));
        self.log_variance += (log_variance - self.log_variance) / f64::from(self.fits);
    }

    /// Variance of the signal; 0 if nothing is known.
    pub fn variance(&self) -> f64 {
        if self.fits == 0 { 0.0 } else { MEAN_OF_LOGARITHMS * libm::exp(self.log_variance) }
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
