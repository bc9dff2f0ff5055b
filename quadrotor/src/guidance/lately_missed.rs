//! What predictions of a signal have missed lately.

use serde::{Deserialize, Serialize};

/// So many predictions count.
const COUNTED: usize = 16;
/// The mean square over the median of the squares of three normal deviates: 3 over the median of χ²₃.
const MEAN_OF_MEDIAN: f64 = 1.268;

/// The mean square of what predictions have missed, over many of them.
///
/// It is a median: the corners of a signal, at which a few predictions miss much, do not count, nor do a few rounded samples that
/// happen to be where they were expected.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct LatelyMissed {
    /// The latest squares; the oldest is replaced next.
    squares: [f64; COUNTED],
    /// How many were seen, and then counted from [`COUNTED`] on again.
    seen: usize,
    mean_square: f64,
}

impl LatelyMissed {
    /// A prediction missed by a square.
    pub fn observe(&mut self, square: f64) {
        if let Some(place) = self.squares.get_mut(self.seen % COUNTED) {
            *place = square;
        }
        self.seen = if self.seen + 1 < 2 * COUNTED { self.seen + 1 } else { COUNTED };
        let mut sorted = self.squares;
        let seen = sorted.get_mut(..self.seen.min(COUNTED)).unwrap_or_default();
        seen.sort_unstable_by(f64::total_cmp);
        let [below, above] =
            [seen.len() - 1, seen.len()].map(|twice| seen.get(twice / 2).copied().unwrap_or_default());
        self.mean_square = MEAN_OF_MEDIAN * (below + above) / 2.0;
    }

    /// 0 if nothing is known.
    pub fn mean_square(&self) -> f64 {
        self.mean_square
    }
}

#[cfg(test)]
mod tests {
    use super::LatelyMissed;

    /// Squares of deviates in three axes as tables of χ² have them, times a variance of 4 in each.
    #[test]
    fn the_mean_square_of_normal_deviates_is_found() {
        // Quantiles of χ²₃ at (k + ½)/16.
        let quantiles = [
            0.252, 0.557, 0.824, 1.083, 1.344, 1.614, 1.898, 2.204, 2.537, 2.907, 3.328, 3.823, 4.429, 5.222,
            6.399, 8.857,
        ];
        let mut missed = LatelyMissed::default();
        for quantile in quantiles {
            missed.observe(4.0 * quantile);
        }
        assert!((missed.mean_square() - 12.0).abs() < 0.4, "{}", missed.mean_square());
    }

    /// Two corners in sixteen predictions of an exact signal, or two exact ones of a noisy signal.
    #[test]
    fn a_few_others_do_not_count() {
        for (few, most) in [(1.0, 1e-28), (0.0, 1.0)] {
            let mut missed = LatelyMissed::default();
            for prediction in 0..64 {
                missed.observe(if prediction % 16 < 2 { few } else { most });
            }
            assert!((missed.mean_square() / most - 1.268).abs() < 1e-9, "{}", missed.mean_square());
        }
    }
}
