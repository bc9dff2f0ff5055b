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
//! What the polynomial leaves is the noise σ of the samples, which makes c_k uncertain by σ²/S_k. A coefficient within twice that
//! is no information: each but c₀ counts as c_k (1 − 4 σ²/(S_k c_k²)), or not at all. So noisy samples have a derivative of low
//! degree, or none.

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
/// Variances that a coefficient loses from its square.
const VARIANCES: f64 = 4.0;

/// Estimates the derivatives of a signal that is set every so often and held in between, from its changes within the last 0.4 s or
/// six of them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DerivativeEstimator<const AXES: usize> {
    /// Time, µs, and value; the newest last, and only the first `count` are used: none of a constant.
    samples: [(u64, SVector<f64, AXES>); CAPACITY],
    count: usize,
    /// The present value, and since when, µs.
    held: SVector<f64, AXES>,
    since_us: u64,
}

/// Derivatives of a signal at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Derivatives<const AXES: usize> {
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

impl<const AXES: usize> Default for DerivativeEstimator<AXES> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const AXES: usize> DerivativeEstimator<AXES> {
    /// A constant.
    pub fn new() -> Self {
        let zero = SVector::zeros();
        Self { samples: [(0, zero); CAPACITY], count: 0, held: zero, since_us: 0 }
    }

    /// Makes it a constant again.
    pub(crate) fn forget(&mut self) {
        (self.count, self.held) = (0, SVector::zeros());
    }

    /// The signal at `time_us`. A change that is faster than `fastest` per second is a jump, not motion: what was before it is
    /// forgotten.
    pub fn observe(&mut self, value: &SVector<f64, AXES>, fastest: f64, time_us: u64) {
        if *value == self.held {
            // A signal that rests begins anew with its next change.
            if time_us.saturating_sub(self.since_us) > self.patience_us() {
                self.count = 0;
            }
            return;
        }
        let Some((last_us, last)) = self.used().last().copied() else {
            self.begin(value, time_us);
            return;
        };
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
        Fit::new(self.used(), time_us).map_or(Derivatives::zero(), |Fit { derivatives, .. }| {
            let [_, first, second] = derivatives;
            Derivatives { first, second }
        })
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
        (value - fit.derivatives[0]).norm() > OFF * largest + DEVIATIONS * fit.deviation
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
    /// Standard deviation of a new sample from its value.
    deviation: f64,
}

/// One polynomial p_k of the basis in a fit.
#[derive(Clone, Copy)]
struct Term<const AXES: usize> {
    /// c_k
    coefficient: SVector<f64, AXES>,
    /// S_k
    size: f64,
    /// p_k and its first and second derivative at the instant.
    there: [f64; 3],
}

impl<const AXES: usize> Fit<AXES> {
    /// `None` with fewer than three samples: there must be one more than the polynomial has coefficients.
    fn new(samples: &[(u64, SVector<f64, AXES>)], time_us: u64) -> Option<Self> {
        let ([(first_us, _), .., (last_us, _)], 3..) = (samples, samples.len()) else { return None };
        let degree = DEGREE.min(samples.len() - 2);
        let half_s = last_us.saturating_sub(*first_us) as f64 / 2e6;
        // −1 at the first sample, 1 at the last
        let abscissa = |at_us: u64| at_us.saturating_sub(*first_us) as f64 / 1e6 / half_s - 1.0;
        let (terms, left) = Self::terms(samples, degree, abscissa, abscissa(time_us));
        let terms = terms.get(..=degree).unwrap_or(&terms);

        let variance = left / (samples.len() - 1 - degree) as f64;
        let (mut derivatives, mut gain) = ([SVector::zeros(); 3], 1.0);
        for (k, Term { coefficient, size, there }) in terms.iter().enumerate() {
            let square = coefficient.norm_squared();
            let noise = if k == 0 { 0.0 } else { VARIANCES * variance / size };
            if square <= noise {
                continue;
            }
            let certain = coefficient * (1.0 - noise / square);
            for (derivative, p) in derivatives.iter_mut().zip(there) {
                *derivative += certain * *p;
            }
            gain += there[0] * there[0] / size;
        }
        derivatives[1] /= half_s;
        derivatives[2] /= half_s * half_s;
        Some(Self { degree, derivatives, deviation: libm::sqrt(variance * gain) })
    }

    /// The terms up to a degree, and the sum of squares that they leave.
    fn terms(
        samples: &[(u64, SVector<f64, AXES>)],
        degree: usize,
        abscissa: impl Fn(u64) -> f64,
        at: f64,
    ) -> ([Term<AXES>; DEGREE + 1], f64) {
        let mut rest: [SVector<f64, AXES>; CAPACITY] = [SVector::zeros(); CAPACITY];
        for (rest, (_, value)) in rest.iter_mut().zip(samples) {
            *rest = *value;
        }
        // p_{k−1} and p_k at the samples, and with their derivatives at the instant.
        let (mut before, mut now) = ([0.0; CAPACITY], [1.0; CAPACITY]);
        let (mut before_there, mut there) = ([0.0; 3], [1.0, 0.0, 0.0]);
        let mut size_before = 1.0;
        let mut terms = [Term { coefficient: SVector::zeros(), size: 1.0, there }; DEGREE + 1];
        for term in terms.iter_mut().take(degree + 1) {
            let (mut size, mut moment, mut coefficient) = (0.0, 0.0, SVector::zeros());
            for ((p, rest), (at_us, _)) in now.iter().zip(&rest).zip(samples) {
                size += p * p;
                moment += abscissa(*at_us) * p * p;
                coefficient += rest * *p;
            }
            coefficient /= size;
            *term = Term { coefficient, size, there };
            let (alpha, beta) = (moment / size, size / size_before);
            for (((p, before), rest), (at_us, _)) in
                now.iter_mut().zip(&mut before).zip(&mut rest).zip(samples)
            {
                *rest -= coefficient * *p;
                (*p, *before) = ((abscissa(*at_us) - alpha) * *p - beta * *before, *p);
            }
            let ([p, slope, curvature], [p_1, slope_1, curvature_1]) = (there, before_there);
            before_there = there;
            there = [
                (at - alpha) * p - beta * p_1,
                p + (at - alpha) * slope - beta * slope_1,
                2.0 * slope + (at - alpha) * curvature - beta * curvature_1,
            ];
            size_before = size;
        }
        (terms, rest.iter().take(samples.len()).map(SVector::norm_squared).sum())
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

    /// Set-points that rest and jump, trembling by rounding or not at all, and one that is held: none of it is motion.
    #[test]
    fn jumps_are_not_motion() {
        for period_us in [10_000, 100_000] {
            let signal =
                |t: f64| Vector3::new(if t < 3.0 { 0.0 } else { 2.5 }, if t < 6.0 { 1.0 } else { -1.0 }, 0.0);
            for (t, found) in estimates(signal, period_us) {
                assert_eq!(found, Derivatives::zero(), "{t}");
            }
        }
    }

    /// Pieces of constant jerk: each is known exactly soon after it has begun, and nothing is made up in between.
    #[test]
    fn pieces_of_constant_jerk_are_known_soon() {
        const JERK: f64 = 4.0;
        for period_us in [1_000, 10_000, 20_000, 50_000] {
            let piece = |t: f64| (t / 0.8) as i32;
            let jerk = |piece: i32| [JERK, 0.0, -JERK, -JERK, 0.0, JERK][piece.rem_euclid(6) as usize];
            let signal = |t: f64| {
                let whole: f64 = (0..piece(t)).map(|piece| 0.8 * jerk(piece)).sum();
                Vector3::x() * (whole + jerk(piece(t)) * (t - 0.8 * f64::from(piece(t))))
            };
            for (t, found) in estimates(signal, period_us) {
                let since = t - 0.8 * f64::from(piece(t));
                let error = (found.first - Vector3::x() * jerk(piece(t))).norm();
                let known = error < 1e-9 && found.second.norm() < 1e-9;
                assert!(known || since < 0.15, "{t} each {period_us} µs: {found:?}");
                assert!(found.first.norm() < JERK + 1e-9 && found.second.norm() < JERK, "{t}: {found:?}");
            }
        }
    }

    /// Evenly distributed with a standard deviation of 1, the same for each number (Steele, Lea and Flood 2014).
    fn noise(number: u64) -> f64 {
        let mut z = number.wrapping_mul(0x9E37_79B9_7F4A_7C15);
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) as f64 / u64::MAX as f64 - 0.5) * 12.0_f64.sqrt()
    }

    /// Root mean squares of the errors of jerk and snap under noise of a standard deviation per axis, m/s².
    fn under_noise(rate: f64, deviation: f64, period_us: u64) -> [f64; 2] {
        let signal = |t: f64| {
            let noise = |axis: u64| noise((t * 1e6).round() as u64 * 3 + axis);
            figure_eight(rate, 0, t) + Vector3::new(noise(0), noise(1), noise(2)) * deviation
        };
        let (mut squares, mut count) = ([0.0; 2], 0.0);
        for (t, found) in estimates(signal, period_us).filter(|(t, _)| *t > 1.0) {
            squares[0] += (found.first - figure_eight(rate, 1, t)).norm_squared();
            squares[1] += (found.second - figure_eight(rate, 2, t)).norm_squared();
            count += 1.0;
        }
        squares.map(|square: f64| (square / count).sqrt())
    }

    /// Noise on a constant is hardly taken for motion. On a motion it costs no more of the jerk than in the difference of two
    /// samples, which comes late besides, and the snap is not worse than zero would be.
    #[test]
    fn noise_makes_estimates_modest() {
        let rms = |rate: f64, order: i32| {
            let axis = |a: f64, w: f64| a * w.powi(order + 2) / 2.0_f64.sqrt();
            axis(6.0, rate).hypot(axis(3.0, 2.0 * rate))
        };
        for period_us in [4_000, 20_000, 50_000] {
            for deviation in [0.01, 0.05, 0.2] {
                let between_two = deviation * 6.0_f64.sqrt() / 0.05;
                let [jerk, snap] = under_noise(0.0, deviation, period_us);
                assert!(jerk < 0.3 * between_two, "{deviation} each {period_us} µs: {jerk}");
                assert!(snap < 12.0 * between_two, "{deviation} each {period_us} µs: {snap}");
                let [jerk, snap] = under_noise(0.85, deviation, period_us);
                assert!(jerk < 1.3 * between_two, "{deviation} each {period_us} µs: {jerk}, {between_two}");
                assert!(deviation > 0.1 || snap < rms(0.85, 2), "{deviation} each {period_us} µs: {snap}");
            }
        }
    }
}
