//! Derivatives of a signal that is known by samples alone.
//!
//! The signal is an input that somebody sets: each millisecond, or every so often, and then it is held. Only changes of the value
//! count as samples, at the time of the change, so that a staircase is read by the instants at which it was set, whatever its
//! period. A polynomial is fitted to the samples of the last 0.4 s, or to seven of them if they are farther apart.
//!
//! Noise makes derivatives from so short a time useless: the deviation of the third one falls with its power of 3.5. So noisy samples
//! are remembered for longer, and a polynomial through all of them counts as long as it leaves no more than the noise. Where they are
//! a motion, [`motion_filters`](super::motion_filters) do better.

use nalgebra::SVector;
use serde::{Deserialize, Serialize};

use crate::guidance::lately_missed::LatelyMissed;
use crate::guidance::polynomial_fit::PolynomialFit;
use crate::guidance::signal_noise::SignalNoise;

/// Samples are at least this far apart, µs.
const SPACING_US: u64 = 40_000;
/// The samples that count without noise are not older than this, µs, or than so many periods of the signal.
const WINDOW_US: u64 = 400_000;
const PERIODS: u64 = 6;
/// So many samples are remembered.
pub(crate) const CAPACITY: usize = 32;
/// What a polynomial through more of them leaves may be so many times the variance of the noise.
const AS_NOISE: f64 = 2.0;
/// Signals that are set less often than this, µs, count as constant between two changes.
const LONGEST_PERIOD_US: u64 = 300_000;
/// A sample off the polynomial by more than this share of the largest recent change, and by so many standard deviations, begins
/// another motion. Sinusoids of up to 3 rad/s, set every 100 ms, are off by half of that.
const OFF: f64 = 0.1;
const DEVIATIONS: f64 = 6.0;
/// Polynomials below this degree do not tell another motion from a curved one.
const TELLING: usize = 3;
/// What misses less than so many times as much, in squares, tells the motion as well as the polynomials: what those make of noisy samples
/// changes from each to the next.
const ALIKE: f64 = 4.0;
/// Among the few samples before that, a change that is so many times as fast as the one before or behind it is a step, not motion. Those
/// of smooth motions become so much faster only where they hardly move.
const STEP: f64 = 4.0;

/// Estimates the derivatives of a signal that is set every so often and held in between, from its changes within the last 0.4 s or
/// seven of them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DerivativeEstimator<const AXES: usize> {
    /// Time, µs, and value; the newest last, and only the first `count` are used: none of a constant.
    samples: [(u64, SVector<f64, AXES>); CAPACITY],
    count: usize,
    /// The present value, and since when, µs.
    held: SVector<f64, AXES>,
    since_us: u64,
    noise: SignalNoise,
    /// What the polynomials have missed of the samples that came next.
    missed: LatelyMissed,
    /// Whether it is the rate of something, whose derivatives count up to the third: an end that comes without notice costs little.
    is_rate: bool,
}

/// What a look at a signal finds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sample {
    /// Nothing new.
    None,
    /// The first sample of a motion, or the second one, if it shows that those before the first were of another motion.
    First,
    /// The next one of it.
    Next,
}

/// A step between two samples.
#[derive(Clone, Copy)]
enum Step {
    /// Before the last sample.
    Before,
    /// After it.
    After,
}

/// Derivatives of a signal at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Derivatives<const AXES: usize> {
    /// Per s.
    pub first: SVector<f64, AXES>,
    /// Per s².
    pub second: SVector<f64, AXES>,
    /// Per s³.
    pub third: SVector<f64, AXES>,
    /// Per s⁴.
    pub fourth: SVector<f64, AXES>,
}

impl<const AXES: usize> Derivatives<AXES> {
    /// Of a constant.
    pub fn zero() -> Self {
        let zero = SVector::zeros();
        Self { first: zero, second: zero, third: zero, fourth: zero }
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
        Self {
            samples: [(0, zero); CAPACITY],
            count: 0,
            held: zero,
            since_us: 0,
            noise: SignalNoise::default(),
            missed: LatelyMissed::default(),
            is_rate: false,
        }
    }

    /// A constant rate.
    pub(crate) fn of_rate() -> Self {
        Self { is_rate: true, ..Self::new() }
    }

    /// Makes it a constant again.
    pub(crate) fn forget(&mut self) {
        (self.count, self.held) = (0, SVector::zeros());
    }

    /// The signal at `time_us`. A change that is faster than `fastest` per second is a jump, not motion: what was before it is
    /// forgotten.
    pub(crate) fn observe(&mut self, value: &SVector<f64, AXES>, fastest: f64, time_us: u64) -> Sample {
        if *value == self.held {
            // A signal that rests begins anew with its next change.
            if time_us.saturating_sub(self.since_us) > self.patience_us() {
                self.count = 0;
            }
            return Sample::None;
        }
        let Some((last_us, last)) = self.used().last().copied() else {
            return self.begin(value, time_us);
        };
        (self.held, self.since_us) = (*value, time_us);
        let elapsed_us = time_us.saturating_sub(last_us);
        let jumps = (value - last).norm() > fastest * (elapsed_us.max(SPACING_US) as f64 / 1e6);
        let recent = if elapsed_us >= SPACING_US { self.recent_fit(time_us) } else { None };
        if let Some(fit) = &recent {
            self.noise.observe(fit.left);
            self.missed.observe((value - fit.derivatives[0]).norm_squared());
        }
        let fit = recent.map(|recent| self.longest_fit(recent, time_us));
        if jumps || fit.as_ref().is_some_and(|fit| self.is_off(value, fit)) {
            return self.begin(value, time_us);
        } else if elapsed_us >= SPACING_US {
            let sample = match self.step_to(value, time_us) {
                Some(Step::After) => return self.begin(value, time_us),
                Some(Step::Before) => self.begin(&last, last_us),
                None => Sample::Next,
            };
            (self.held, self.since_us) = (*value, time_us);
            self.push(value, time_us);
            return sample;
        }
        Sample::None
    }

    /// Another origin: as if the signal had always been elsewhere.
    pub(crate) fn shift(&mut self, by: &SVector<f64, AXES>) {
        self.held += by;
        self.samples.iter_mut().for_each(|(_, value)| *value += by);
    }

    /// How many samples are known of the motion.
    pub(crate) fn samples(&self) -> usize {
        self.count
    }

    /// Whether what misses the samples of a motion by a mean square tells it as well as the polynomials.
    pub(crate) fn is_told_as_well(&self, missed: f64) -> bool {
        self.count > 2 && missed < ALIKE * self.missed.mean_square()
    }

    /// The derivatives at `time_us`: zero of a signal that is constant or has just begun.
    pub fn at(&self, time_us: u64) -> Derivatives<AXES> {
        self.fit(time_us).map_or(Derivatives::zero(), |fit| {
            let [_, first, second, third, fourth] = fit.derivatives;
            Derivatives { first, second, third, fourth }
        })
    }

    /// The polynomial that counts.
    fn fit(&self, time_us: u64) -> Option<PolynomialFit<AXES>> {
        self.recent_fit(time_us).map(|recent| self.longest_fit(recent, time_us))
    }

    /// The polynomial through the recent samples.
    fn recent_fit(&self, time_us: u64) -> Option<PolynomialFit<AXES>> {
        PolynomialFit::new(self.newest(self.recent()), (self.noise.variance(), self.is_rate), time_us)
    }

    /// The one through the most samples, up to all, that leaves no more than the noise and, of a rate, knows of no corner where those before know of none; or
    /// else that through the recent ones.
    fn longest_fit(&self, recent: PolynomialFit<AXES>, time_us: u64) -> PolynomialFit<AXES> {
        let (variance, fitted) = (self.noise.variance(), self.recent());
        let mut longest = recent;
        for count in [(fitted + self.count) / 2, self.count].into_iter().filter(|count| *count > fitted) {
            match PolynomialFit::new(self.newest(count), (variance, self.is_rate), time_us) {
                Some(fit)
                    if fit.left <= AS_NOISE * variance
                        && (fit.smooth || !(self.is_rate && longest.smooth)) =>
                {
                    longest = fit
                }
                _ => break,
            }
        }
        longest
    }

    /// How many samples count without noise.
    fn recent(&self) -> usize {
        let Some((last_us, _)) = self.used().last() else { return 0 };
        let oldest_us = last_us.saturating_sub(WINDOW_US.max(PERIODS * self.period_us().unwrap_or(0)));
        self.used().iter().filter(|(sample_us, _)| *sample_us >= oldest_us).count()
    }

    /// So many of the newest samples, or all.
    fn newest(&self, count: usize) -> &[(u64, SVector<f64, AXES>)] {
        let used = self.used();
        used.get(used.len().saturating_sub(count)..).unwrap_or(used)
    }

    fn used(&self) -> &[(u64, SVector<f64, AXES>)] {
        self.samples.get(..self.count).unwrap_or(&self.samples)
    }

    fn begin(&mut self, value: &SVector<f64, AXES>, time_us: u64) -> Sample {
        (self.samples[0], self.count) = ((time_us, *value), 1);
        (self.held, self.since_us) = (*value, time_us);
        Sample::First
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
    fn is_off(&self, value: &SVector<f64, AXES>, fit: &PolynomialFit<AXES>) -> bool {
        if fit.degree < TELLING {
            return false;
        }
        let largest = self
            .newest(self.recent())
            .windows(2)
            .map(|pair| match pair {
                [(_, before), (_, after)] => (after - before).norm(),
                _ => 0.0,
            })
            .fold(0.0, f64::max);
        (value - fit.derivatives[0]).norm() > OFF * largest + DEVIATIONS * fit.deviation
    }

    /// Where a new sample shows a step, while there are few of them: behind the last one, or before it if that was the second.
    fn step_to(&self, value: &SVector<f64, AXES>, time_us: u64) -> Option<Step> {
        let used = self.used();
        let [.., (first_us, first), (last_us, last)] = used else { return None };
        if used.len() >= TELLING + 2 {
            return None;
        }
        let noise = DEVIATIONS * libm::sqrt(2.0 * self.noise.variance());
        let [before_s, after_s] =
            [last_us.saturating_sub(*first_us), time_us.saturating_sub(*last_us)].map(|us| us as f64 / 1e6);
        let (before, after) = ((last - first).norm(), (value - last).norm());
        if after > STEP * before * after_s / before_s + noise {
            Some(Step::After)
        } else if used.len() == 2 && before > STEP * after * before_s / after_s + noise {
            Some(Step::Before)
        } else {
            None
        }
    }

    fn push(&mut self, value: &SVector<f64, AXES>, time_us: u64) {
        if self.count == CAPACITY {
            self.samples.rotate_left(1);
            self.count -= 1;
        }
        if let Some(sample) = self.samples.get_mut(self.count) {
            *sample = (time_us, *value);
            self.count += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;
    use core::f64::consts::FRAC_PI_2;

    use nalgebra::Vector3;

    use super::{DerivativeEstimator, Derivatives, SPACING_US};

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
        estimates_by(DerivativeEstimator::new(), signal, period_us)
    }

    /// The same by another estimator.
    fn estimates_by(
        mut estimator: DerivativeEstimator<3>,
        signal: impl Fn(f64) -> Vector3<f64>,
        period_us: u64,
    ) -> impl Iterator<Item = (f64, Derivatives<3>)> {
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

    /// A quintic from 0 to 3 within a second, beside which its terms of odd degree vanish in the middle: it is no corner there, but known from
    /// 0.35 s on until it ends.
    #[test]
    fn a_quintic_is_known_all_the_way() {
        for period_us in [10_000, 20_000, 50_000] {
            let signal = |t: f64| {
                let s = (t - 1.0).clamp(0.0, 1.0);
                Vector3::x() * (3.0 * s.powi(3) * (10.0 - 15.0 * s + 6.0 * s * s))
            };
            let first = |s: f64| 90.0 * s * s * (1.0 - s).powi(2);
            let second = |s: f64| 180.0 * s * (1.0 - s) * (1.0 - 2.0 * s);
            let estimates = estimates_by(DerivativeEstimator::of_rate(), signal, period_us);
            for (t, found) in estimates.filter(|(t, _)| (1.36..1.99).contains(t)) {
                let errors = [found.first.x - first(t - 1.0), found.second.x - second(t - 1.0)];
                assert!(
                    errors[0].abs() < 0.05 && errors[1].abs() < 0.5,
                    "{t} each {period_us} µs: {errors:?}"
                );
            }
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

    /// A level circle of 12 m, flown under accelerations of 0.8 m/s² along it that change their sign so many times a second: the
    /// acceleration after a time, or its derivative where it has one.
    fn trapezoids(period_s: f64, order: i32, t: f64) -> Vector3<f64> {
        const RADIUS_M: f64 = 12.0;
        let (push, whole) = (0.8, libm::floor(t / period_s));
        let since = t - whole * period_s;
        let (start, sign) = if whole as i32 % 2 == 0 { (3.0, 1.0) } else { (3.0 + push * period_s, -1.0) };
        let (speed, a) = (start + sign * push * since, sign * push);
        let way = whole * period_s * (3.0 + push * period_s / 2.0) + (start + speed) / 2.0 * since;
        let (sin, cos) = (way / RADIUS_M).sin_cos();
        let (along, inward) = (Vector3::new(-sin, cos, 0.0), Vector3::new(-cos, -sin, 0.0));
        match order {
            0 => along * a + inward * (speed * speed / RADIUS_M),
            _ => {
                inward * (3.0 * speed * a / RADIUS_M) - along * (speed * speed * speed / RADIUS_M / RADIUS_M)
            }
        }
    }

    /// The acceleration of 0.8 m/s² turns round at once; taken for motion, that was a jerk of up to 100 m/s³. The oracle is the
    /// motion between the steps: jerk is hardly larger than there, and is found soon after a step where the samples allow.
    #[test]
    fn steps_of_a_moving_acceleration_are_no_jerk() {
        for period_us in [1_000, 10_000, 20_000, 50_000, 100_000] {
            for period_s in [0.1, 0.15, 0.31, 0.47, 0.83, 1.7] {
                // Between two steps there must be more than two samples.
                if period_s < 2.4e-6 * period_us.max(SPACING_US) as f64 {
                    continue;
                }
                let signal = |t: f64| trapezoids(period_s, 0, t);
                for (t, found) in estimates(signal, period_us) {
                    let largest = 2.5;
                    assert!(
                        found.first.norm() < largest,
                        "{t} each {period_us} µs, {period_s} s: {}",
                        found.first.norm()
                    );
                    let since = t - libm::floor(t / period_s) * period_s;
                    let off = (found.first - trapezoids(period_s, 1, t)).norm();
                    let soon = 0.2 + 4.0e-6 * period_us as f64;
                    assert!(
                        t < 1.0 || since < soon || off < 0.1,
                        "{t} each {period_us} µs, {period_s} s: {off}"
                    );
                }
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

    /// Ten samples a second leave one for the noise in a window: it is known from the windows before.
    #[test]
    fn noise_on_few_samples_is_known_from_those_before() {
        for period_us in [50_000, 100_000] {
            let between_two = 0.01 * 6.0_f64.sqrt() / (1e-6 * period_us as f64);
            let signal = |t: f64| {
                let noise = |axis: u64| noise((t * 1e6).round() as u64 * 3 + axis);
                Vector3::new(noise(0), noise(1), noise(2)) * 0.01
            };
            let late = estimates(signal, period_us).filter(|(t, _)| *t > 4.0);
            let squares: Vec<f64> = late.map(|(_, found)| found.first.norm_squared()).collect();
            let rms = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
            assert!(rms < 0.2 * between_two, "each {period_us} µs: {rms}, {between_two}");
        }
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
