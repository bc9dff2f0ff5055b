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

    /// The one through the most samples, up to all, that leaves no more than the noise; or else that through the recent ones. Of a rate, one
    /// that knows of no corner is not replaced by one that does.
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
mod tests;
