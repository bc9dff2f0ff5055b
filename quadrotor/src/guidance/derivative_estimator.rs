//! First and second derivative of a signal that is known by samples alone.
//!
//! The signal is an input that somebody sets: each millisecond, or every so often, and then it is held. Only changes of the value
//! count as samples, at the time of the change, so that a staircase is read by the instants at which it was set, whatever its
//! period. A polynomial of up to fourth degree is fitted to the samples of the last 0.4 s, or to six of them if they are farther
//! apart, in the basis of its discrete orthogonal polynomials (Forsythe 1957):
//!
//! ```text
//! p₋₁ = 0,  p₀ = 1,  p_{k+1}(x) = (x − α_k) p_k(x) − β_k p_{k−1}(x)
//! α_k = Σ x p_k²/S_k,  β_k = S_k/S_{k−1},  S_k = Σ p_k²,  c_k = Σ y p_k/S_k
//! ```
//!
//! What the polynomial leaves is the noise σ of the samples. It makes a derivative uncertain by σ² Σ p_k'²/S_k; a derivative that
//! is not larger than that is no information, and is reduced: d (1 − 4 variance/d²).

use nalgebra::SVector;
use serde::{Deserialize, Serialize};

/// Samples are at least this far apart, µs.
const SPACING_US: u64 = 40_000;
/// The samples that count are not older than this, µs, or than so many periods of the signal.
const WINDOW_US: u64 = 400_000;
const PERIODS: u64 = 5;
/// Room for all of them.
const CAPACITY: usize = 12;
/// Signals that are set less often than this, µs, count as constant between two changes.
const LONGEST_PERIOD_US: u64 = 300_000;
/// Largest degree of the polynomial.
const DEGREE: usize = 4;
/// A sample off the polynomial by more than this share of the largest recent change, and by so many standard deviations, begins
/// another motion. Sinusoids of up to 3 rad/s, set every 100 ms, are off by half of that.
const OFF: f64 = 0.1;
const DEVIATIONS: f64 = 6.0;
/// Polynomials below this degree do not tell another motion from a curved one.
const TELLING: usize = 3;
/// Variances that a derivative loses from its square.
const VARIANCES: f64 = 4.0;

/// Recent samples of a signal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct DerivativeEstimator<const AXES: usize> {
    /// Time, µs, and value; the newest last, and only the first `count` are used.
    samples: [(u64, SVector<f64, AXES>); CAPACITY],
    count: usize,
    /// The present value, and since when, µs.
    held: SVector<f64, AXES>,
    since_us: u64,
}

/// Derivatives of a signal at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Derivatives<const AXES: usize> {
    /// Per s.
    pub first: SVector<f64, AXES>,
    /// Per s².
    pub second: SVector<f64, AXES>,
}

impl<const AXES: usize> Derivatives<AXES> {
    /// Of a constant.
    pub fn zero() -> Self {
        Self { first: SVector::zeros(), second: SVector::zeros() }
    }
}

impl<const AXES: usize> DerivativeEstimator<AXES> {
    /// Without any sample.
    pub fn new() -> Self {
        let zero = SVector::zeros();
        Self { samples: [(0, zero); CAPACITY], count: 0, held: zero, since_us: 0 }
    }

    /// The signal at `time_us`. A change that is faster than `fastest` per second is a jump, not motion: what was before it is
    /// forgotten.
    pub fn observe(&mut self, value: &SVector<f64, AXES>, fastest: f64, time_us: u64) {
        let Some((last_us, last)) = self.used().last().copied() else {
            self.begin(value, time_us);
            return;
        };
        if *value == self.held {
            if time_us.saturating_sub(self.since_us) > self.patience_us() {
                let since_us = self.since_us;
                self.begin(value, time_us);
                self.since_us = since_us;
            }
            return;
        }
        (self.held, self.since_us) = (*value, time_us);
        let elapsed_us = time_us.saturating_sub(last_us);
        let jumps = (value - last).norm() > fastest * (elapsed_us.max(SPACING_US) as f64 / 1e6);
        if jumps || elapsed_us >= SPACING_US && self.is_off(value, time_us) {
            self.begin(value, time_us);
        } else if elapsed_us >= SPACING_US {
            self.push(value, time_us);
        }
    }

    /// The derivatives at `time_us`: zero of a signal that is constant or has just begun.
    pub fn at(&self, time_us: u64) -> Derivatives<AXES> {
        let Some(fit) = Fit::new(self.used(), time_us) else { return Derivatives::zero() };
        let certain = |derivative: SVector<f64, AXES>, gain: f64| {
            let square = derivative.norm_squared();
            let lost = VARIANCES * gain * fit.variance;
            if square > lost { derivative * (1.0 - lost / square) } else { SVector::zeros() }
        };
        Derivatives {
            first: certain(fit.derivatives[1], fit.gains[1]),
            second: certain(fit.derivatives[2], fit.gains[2]),
        }
    }

    fn used(&self) -> &[(u64, SVector<f64, AXES>)] {
        self.samples.get(..self.count).unwrap_or(&self.samples)
    }

    fn begin(&mut self, value: &SVector<f64, AXES>, time_us: u64) {
        (self.samples[0], self.count) = ((time_us, *value), 1);
        (self.held, self.since_us) = (*value, time_us);
    }

    /// Time between the last two samples, µs.
    fn period_us(&self) -> Option<u64> {
        match self.used() {
            [.., (before_us, _), (last_us, _)] => Some(last_us.saturating_sub(*before_us)),
            _ => None,
        }
    }

    /// How long a signal that moves may keep a value, µs.
    fn patience_us(&self) -> u64 {
        self.period_us().map_or(LONGEST_PERIOD_US, |period_us| period_us + period_us / 2)
    }

    /// Whether a value does not continue the motion so far.
    fn is_off(&self, value: &SVector<f64, AXES>, time_us: u64) -> bool {
        let Some(fit) = Fit::new(self.used(), time_us).filter(|fit| fit.degree >= TELLING) else {
            return false;
        };
        let largest = self
            .used()
            .windows(2)
            .map(|pair| match pair {
                [(_, before), (_, after)] => (after - before).norm(),
                _ => 0.0,
            })
            .fold(0.0, f64::max);
        let noise = libm::sqrt(fit.variance * (1.0 + fit.gains[0]));
        (value - fit.derivatives[0]).norm() > OFF * largest + DEVIATIONS * noise
    }

    fn push(&mut self, value: &SVector<f64, AXES>, time_us: u64) {
        let period_us = self.used().last().map_or(0, |(last_us, _)| time_us.saturating_sub(*last_us));
        let oldest_us = time_us.saturating_sub(WINDOW_US.max(PERIODS * period_us));
        let full = usize::from(self.count == CAPACITY);
        let old = self.used().iter().filter(|(sample_us, _)| *sample_us < oldest_us).count().max(full);
        self.samples.rotate_left(old);
        self.count -= old;
        if let Some(sample) = self.samples.get_mut(self.count) {
            *sample = (time_us, *value);
            self.count += 1;
        }
    }
}

/// A least-squares polynomial, seen at one instant.
struct Fit<const AXES: usize> {
    degree: usize,
    /// Its value and first and second derivative.
    derivatives: [SVector<f64, AXES>; 3],
    /// The variance of each of them in units of that of a sample.
    gains: [f64; 3],
    /// Variance of a sample, of all axes together.
    variance: f64,
}

impl<const AXES: usize> Fit<AXES> {
    /// `None` with fewer than three samples: there must be one more than the polynomial has coefficients.
    fn new(samples: &[(u64, SVector<f64, AXES>)], time_us: u64) -> Option<Self> {
        let ([(first_us, _), .., (last_us, _)], 3..) = (samples, samples.len()) else { return None };
        let degree = DEGREE.min(samples.len() - 2);
        let half_s = last_us.saturating_sub(*first_us) as f64 / 2e6;
        // −1 at the first sample, 1 at the last
        let abscissa = |at_us: u64| at_us.saturating_sub(*first_us) as f64 / 1e6 / half_s - 1.0;
        let at = abscissa(time_us);

        let mut rest: [SVector<f64, AXES>; CAPACITY] = [SVector::zeros(); CAPACITY];
        for (rest, (_, value)) in rest.iter_mut().zip(samples) {
            *rest = *value;
        }
        // p_{k−1} and p_k at the samples, and with their derivatives at the instant.
        let (mut before, mut now) = ([0.0; CAPACITY], [1.0; CAPACITY]);
        let (mut before_there, mut there) = ([0.0; 3], [1.0, 0.0, 0.0]);
        let mut size_before = 1.0;
        let mut fit = Self { degree, derivatives: [SVector::zeros(); 3], gains: [0.0; 3], variance: 0.0 };
        for _ in 0..=degree {
            let (mut size, mut moment, mut coefficient) = (0.0, 0.0, SVector::zeros());
            for ((p, rest), (at_us, _)) in now.iter().zip(&rest).zip(samples) {
                size += p * p;
                moment += abscissa(*at_us) * p * p;
                coefficient += rest * *p;
            }
            coefficient /= size;
            for (p, rest) in now.iter().zip(rest.iter_mut()).take(samples.len()) {
                *rest -= coefficient * *p;
            }
            for ((derivative, gain), p) in fit.derivatives.iter_mut().zip(&mut fit.gains).zip(there) {
                *derivative += coefficient * p;
                *gain += p * p / size;
            }
            let (alpha, beta) = (moment / size, size / size_before);
            for ((p, before), (at_us, _)) in now.iter_mut().zip(&mut before).zip(samples) {
                (*p, *before) = ((abscissa(*at_us) - alpha) * *p - beta * *before, *p);
            }
            let [p, slope, curvature] = there;
            let [p_before, slope_before, curvature_before] = before_there;
            before_there = there;
            there = [
                (at - alpha) * p - beta * p_before,
                p + (at - alpha) * slope - beta * slope_before,
                2.0 * slope + (at - alpha) * curvature - beta * curvature_before,
            ];
            size_before = size;
        }
        let left: f64 = rest.iter().take(samples.len()).map(SVector::norm_squared).sum();
        fit.variance = left / (samples.len() - 1 - degree) as f64;
        let unit = 1.0 / half_s;
        fit.derivatives[1] *= unit;
        fit.derivatives[2] *= unit * unit;
        fit.gains[1] *= unit * unit;
        fit.gains[2] *= unit * unit * unit * unit;
        Some(fit)
    }
}

#[cfg(test)]
mod tests {
    use core::f64::consts::FRAC_PI_2;

    use nalgebra::Vector3;

    use super::{DerivativeEstimator, Derivatives};

    const FASTEST: f64 = 200.0;

    /// The acceleration of 6 sin(ω t), 3 sin(2 ω t), or its derivative of an order.
    fn figure_eight(rate: f64, order: i32, t: f64) -> Vector3<f64> {
        let axis = |a: f64, w: f64| {
            let order = order + 2;
            a * w.powi(order) * (w * t + f64::from(order) * FRAC_PI_2).sin()
        };
        Vector3::new(axis(6.0, rate), axis(3.0, 2.0 * rate), 0.0)
    }

    /// What is estimated each 50 ms from 0 to 12 s, with its time, s, of a signal that is set each `period_us`.
    fn estimates(
        signal: impl Fn(f64) -> Vector3<f64>,
        period_us: u64,
    ) -> impl Iterator<Item = (f64, Derivatives<3>)> {
        let mut estimator = DerivativeEstimator::new();
        (0..12_000_u64).filter_map(move |millisecond| {
            let time_us = millisecond * 1_000;
            let set_us = time_us / period_us * period_us;
            estimator.observe(&signal(set_us as f64 * 1e-6), FASTEST, time_us);
            (millisecond % 50 == 0).then(|| (time_us as f64 * 1e-6, estimator.at(time_us)))
        })
    }

    /// Largest errors of jerk and snap after the first second, as shares of their amplitudes.
    fn worst(rate: f64, period_us: u64) -> [f64; 2] {
        let amplitude = |order: i32| 6.0 * rate.powi(order) + 3.0 * (2.0 * rate).powi(order);
        let mut worst = [0.0_f64; 2];
        for (t, found) in estimates(|t| figure_eight(rate, 0, t), period_us).filter(|(t, _)| *t > 1.0) {
            let errors = [found.first - figure_eight(rate, 1, t), found.second - figure_eight(rate, 2, t)];
            worst[0] = worst[0].max(errors[0].norm() / amplitude(3));
            worst[1] = worst[1].max(errors[1].norm() / amplitude(4));
        }
        worst
    }

    /// Whether the input is set each 1, 10, 20 or 50 ms does not matter; each 100 ms it is known later.
    #[test]
    fn figure_eights_are_differentiated_whatever_the_period_of_the_input() {
        for rate in [0.7, 0.85, 1.2, 1.5] {
            for period_us in [1_000, 4_000, 10_000, 20_000, 50_000] {
                let [jerk, snap] = worst(rate, period_us);
                assert!(jerk < 0.01 && snap < 0.05, "{rate} rad/s each {period_us} µs: {jerk} {snap}");
            }
            let [jerk, snap] = worst(rate, 100_000);
            let share = if rate < 1.0 { 1.0 } else { 4.0 };
            assert!(jerk < 0.01 * share && snap < 0.05 * share, "{rate} rad/s each 100 ms: {jerk} {snap}");
        }
    }
}
