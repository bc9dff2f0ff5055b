//! Recursive least squares with forgetting, a prior that bounds what is forgotten, and bounds on the estimate.

use nalgebra::{SMatrix, SVector};
use serde::{Deserialize, Serialize};

use crate::finite::are_finite;

/// What rounding may add to a variance.
const ROUNDING: f64 = 1.0 + 1e-9;

/// What is known of N numbers before anything is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Prior<const N: usize> {
    /// Standard deviation of each.
    pub(crate) deviation: SVector<f64, N>,
    /// Range that an estimate never leaves.
    pub(crate) range: [SVector<f64, N>; 2],
}

/// An estimate of N numbers and its covariance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct BoundedEstimate<const N: usize> {
    mean: SVector<f64, N>,
    covariance: SMatrix<f64, N, N>,
}

impl<const N: usize> Prior<N> {
    fn covariance(&self) -> SMatrix<f64, N, N> {
        SMatrix::from_diagonal(&self.deviation.component_mul(&self.deviation))
    }

    fn clamped(&self, mean: &SVector<f64, N>) -> SVector<f64, N> {
        let [least, most] = &self.range;
        SVector::from_fn(|i, _| mean[i].max(least[i]).min(most[i]))
    }
}

impl<const N: usize> BoundedEstimate<N> {
    /// The prior about a mean, which is moved into its range.
    pub(crate) fn new(prior: &Prior<N>, mean: &SVector<f64, N>) -> Self {
        Self { mean: prior.clamped(mean), covariance: prior.covariance() }
    }

    /// The estimate.
    pub(crate) fn mean(&self) -> &SVector<f64, N> {
        &self.mean
    }

    /// Opens the estimate of some of the numbers to another truth: it stays, with the deviation of the prior.
    pub(crate) fn open(&mut self, prior: &Prior<N>, opened: &[bool; N]) {
        for i in (0..N).filter(|i| opened[*i]) {
            self.covariance.row_mut(i).fill(0.0);
            self.covariance.column_mut(i).fill(0.0);
            self.covariance[(i, i)] = prior.deviation[i] * prior.deviation[i];
        }
    }

    /// Forgets for a time t: P ← D P D + (1 − D²) P₀ with D = e^(−t/T), what is kept of each number. A covariance stays one. Forgetting
    /// ends at the prior's deviation, so that without excitation nothing winds up.
    pub(crate) fn forget(&mut self, prior: &Prior<N>, kept: &SVector<f64, N>) {
        for (i, column) in self.covariance.as_mut_slice().chunks_exact_mut(N).enumerate() {
            for (number, other) in column.iter_mut().zip(kept.as_slice()) {
                *number *= other * kept[i];
            }
            let deviation = prior.deviation[i];
            column[i] += (1.0 - kept[i] * kept[i]) * deviation * deviation;
        }
    }

    /// y − hᵀ x̂: what the estimate does not explain.
    pub(crate) fn innovation(&self, row: &SVector<f64, N>, value: f64) -> f64 {
        value - row.dot(&self.mean)
    }

    /// √(hᵀ P h): how far what the estimate says of a measurement may be off.
    pub(crate) fn deviation(&self, row: &SVector<f64, N>) -> f64 {
        libm::sqrt(row.dot(&(self.covariance * row)).max(0.0))
    }

    /// Takes in a measurement y = hᵀ x with noise of this variance, and learns those numbers that are `learned` from it: the
    /// others stay, and count with their uncertainty (Schmidt 1966). One that rounding makes useless is ignored.
    pub(crate) fn update(
        &mut self,
        prior: &Prior<N>,
        learned: &[bool; N],
        row: &SVector<f64, N>,
        (value, variance): (f64, f64),
    ) {
        let spread = self.covariance * row;
        let root = libm::sqrt(1.0 / (row.dot(&spread) + variance));
        // Joseph's form (I − k hᵀ) P (I − k hᵀ)ᵀ + k r kᵀ with the gains k = P h/(hᵀ P h + r) of those that are learned, and no gain of the
        // others, is P − s sᵀ with s = P h/√(hᵀ P h + r), but for those of which neither is learned.
        let taken = spread * root;
        let moving = SVector::from_fn(|i, _| if learned[i] { taken[i] } else { 0.0 });
        let mean = self.mean + moving * (root * self.innovation(row, value));
        // No measurement makes anything less certain. What is not finite does not leave the diagonal so.
        let narrower = (0..N).all(|i| {
            let (before, after) = (self.covariance[(i, i)], self.covariance[(i, i)] - moving[i] * taken[i]);
            after >= 0.0 && after <= before * ROUNDING
        });
        if variance > 0.0 && narrower && are_finite(mean.as_slice()) {
            self.mean = mean;
            // By columns, so that several numbers are calculated at once.
            for (j, column) in self.covariance.as_mut_slice().chunks_exact_mut(N).enumerate() {
                let side = if learned[j] { &taken } else { &moving };
                for (number, side) in column.iter_mut().zip(side.as_slice()) {
                    *number -= side * taken[j];
                }
            }
            self.project(prior);
        }
    }

    /// Back into the range, by the way that the covariance makes likeliest: what was taken for a number beyond its bound
    /// goes to those that are correlated with it.
    fn project(&mut self, prior: &Prior<N>) {
        let [least, most] = &prior.range;
        if (0..N).all(|i| (least[i]..=most[i]).contains(&self.mean[i])) {
            return;
        }
        for i in 0..N {
            let beyond = self.mean[i] - self.mean[i].max(least[i]).min(most[i]);
            let variance = self.covariance[(i, i)];
            if beyond != 0.0 && variance > 0.0 {
                let mean = self.mean - self.covariance.column(i) * (beyond / variance);
                if are_finite(mean.as_slice()) {
                    self.mean = mean;
                }
            }
        }
        self.mean = prior.clamped(&self.mean);
    }

    /// Whether it can be an estimate: within its range, and with a covariance within the prior's.
    pub(crate) fn is_possible(&self, prior: &Prior<N>) -> bool {
        prior.clamped(&self.mean) == self.mean
            && are_finite(self.covariance.as_slice())
            && (0..N).all(|i| {
                let most = prior.deviation[i] * prior.deviation[i] * ROUNDING;
                (0.0..=most).contains(&self.covariance[(i, i)])
            })
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector, Vector2, Vector3};
    use proptest::prelude::*;

    use super::{BoundedEstimate, Prior};

    fn prior() -> Prior<3> {
        Prior {
            deviation: Vector3::new(0.5, 0.3, 3.0),
            range: [Vector3::new(0.4, 0.0, -30.0), Vector3::new(2.5, 2.0, 30.0)],
        }
    }

    /// Without forgetting and away from the bounds it is batch least squares with the prior as measurements of their own.
    #[test]
    fn it_equals_batch_least_squares() {
        let prior = prior();
        let start = Vector3::new(1.0, 0.1, 0.5);
        let mut estimate = BoundedEstimate::new(&prior, &start);
        let truth = Vector3::new(1.2, 0.3, -0.7);
        const COUNT: usize = 40;
        let mut rows = DMatrix::zeros(COUNT + 3, 3);
        let mut values = DVector::zeros(COUNT + 3);
        for sample in 0..COUNT {
            let x = sample as f64;
            let row = Vector3::new(9.8 + (0.7 * x).sin(), (0.3 * x).cos() * 2.0, 1.0);
            let value = row.dot(&truth) + 0.05 * (17.0 * x).sin();
            let deviation = 0.1 + 0.01 * x;
            estimate.update(&prior, &[true; 3], &row, (value, deviation * deviation));
            rows.row_mut(sample).copy_from(&(row.transpose() / deviation));
            values[sample] = value / deviation;
        }
        for i in 0..3 {
            rows[(COUNT + i, i)] = 1.0 / prior.deviation[i];
            values[COUNT + i] = start[i] / prior.deviation[i];
        }
        let batch = rows.svd(true, true).solve(&values, 0.0).unwrap();
        for i in 0..3 {
            assert!((estimate.mean()[i] - batch[i]).abs() < 1e-9, "{} {batch}", estimate.mean());
        }
    }

    /// What is kept after a time, s.
    fn kept(time_s: f64) -> Vector3<f64> {
        Vector3::new(100.0, 50.0, 10.0).map(|memory_s| f64::exp(-time_s / memory_s))
    }

    /// What is learned of the sum of two numbers goes to each by its variance, and to the other one beyond a bound.
    #[test]
    fn a_bound_hands_the_rest_on() {
        let prior = Prior {
            deviation: Vector2::new(1.0, 2.0),
            range: [Vector2::new(-1.0, -100.0), Vector2::new(1.0, 100.0)],
        };
        let mut estimate = BoundedEstimate::new(&prior, &Vector2::zeros());
        estimate.update(&prior, &[true; 2], &Vector2::new(1.0, 1.0), (2.0, 1e-12));
        assert!((estimate.mean() - Vector2::new(0.4, 1.6)).norm() < 1e-9, "{}", estimate.mean());
        let mut estimate = BoundedEstimate::new(&prior, &Vector2::zeros());
        estimate.update(&prior, &[true; 2], &Vector2::new(1.0, 1.0), (20.0, 1e-12));
        assert!((estimate.mean() - Vector2::new(1.0, 19.0)).norm() < 1e-6, "{}", estimate.mean());
    }

    /// Forgetting for ever leads to the prior's deviation, about the estimate.
    #[test]
    fn forgetting_ends_at_the_prior() {
        let prior = prior();
        let mut estimate = BoundedEstimate::new(&prior, &Vector3::new(1.0, 0.0, 0.0));
        estimate.update(&prior, &[true; 3], &Vector3::new(1.0, 0.0, 0.0), (1.4, 1e-6));
        let learned = *estimate.mean();
        for _ in 0..10 {
            estimate.forget(&prior, &kept(1_000.0));
        }
        let mut open = estimate;
        open.open(&prior, &[true; 3]);
        assert_eq!(estimate.mean(), &learned);
        assert!((estimate.covariance - open.covariance).norm() < 1e-9);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        /// Whatever is measured, the estimate stays in its range and its covariance within the prior's.
        #[test]
        fn bounds_are_never_left(
            measurements in prop::collection::vec(
                (
                    [any::<f64>(), any::<f64>(), any::<f64>()],
                    any::<f64>(),
                    prop_oneof![0.0..1.0_f64, Just(0.0_f64), Just(1e-300_f64), any::<f64>()],
                    0.0..1e4,
                    any::<[bool; 3]>(),
                ),
                1..60,
            ),
            tame in any::<bool>(),
        ) {
            let prior = prior();
            let mut estimate = BoundedEstimate::new(&prior, &Vector3::new(1.0, 0.0, 0.0));
            let scaled = |number: f64| -> f64 { if tame && number.is_finite() { 20.0 * number.sin() } else { number } };
            for (row, value, variance, time_s, learned) in measurements {
                estimate.forget(&prior, &kept(time_s));
                let variance: f64 = if tame { f64::abs(variance).clamp(1e-4, 1e3) } else { variance };
                let row = Vector3::from(row.map(scaled));
                estimate.update(&prior, &learned, &row, (scaled(value), variance));
                prop_assert!(estimate.is_possible(&prior), "{:?}", estimate);
            }
        }
    }
}
