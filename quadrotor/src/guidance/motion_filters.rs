//! Motions by noisy samples: Kalman filters of several bandwidths.
//!
//! Nobody knows how quickly a motion changes, and so how far back its samples tell of it. Each filter supposes another bandwidth b: the
//! sixth derivative is white noise, of such a density that noise of the samples and motion weigh alike at b. Those whose
//! predictions have missed the samples least tell the motion.
//!
//! In zᵢ = x⁽ⁱ⁾/bⁱ, with τ = b Δt since the sample before and the variance of a sample as a unit, all filters have the same equations
//! (Kalman 1960):
//!
//! ```text
//! z⁻ = Φ z,  P⁻ = Φ P Φᵀ + Q        Φᵢⱼ = τ^(j−i)/(j−i)!  for j ≥ i
//! Qᵢⱼ = τ^(12−i−j)/((5−i)! (5−j)! (11−i−j))
//! K = P⁻ e₀/(P⁻₀₀ + 1),  z = z⁻ + K (y − z⁻₀)ᵀ,  P = P⁻ − K e₀ᵀ P⁻
//! ```

use nalgebra::SVector;
use serde::{Deserialize, Serialize};

/// Bandwidths, rad/s.
const BANDWIDTHS_RAD_S: [f64; 7] = [1.0, 1.5, 2.2, 3.3, 5.0, 7.5, 11.0];
/// Derivatives of a state, from that of order 0 on.
const ORDERS: usize = 6;
/// Variance of each derivative that no sample has told yet, as a multiple of that of a sample.
const UNKNOWN: f64 = 1e6;
/// A prediction that is more uncertain than that, as a multiple of the variance of a sample, says nothing about its filter.
const TELLING: f64 = 1e3;
/// A filter counts by this power of the mean square that it has missed, as a share of the least one: half of it is as good as none.
const CHOOSY: f64 = 8.0;

/// One vector for each order.
type Rows<const COLUMNS: usize> = [SVector<f64, COLUMNS>; ORDERS];

/// What the samples of a motion tell of it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct MotionFilters<const AXES: usize> {
    filters: [MotionFilter<AXES>; BANDWIDTHS_RAD_S.len()],
    /// Of the last sample, µs.
    time_us: u64,
}

/// The estimate of one filter.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct MotionFilter<const AXES: usize> {
    /// zᵢ in row i.
    state: Rows<AXES>,
    /// P, of each axis.
    covariance: Rows<ORDERS>,
    missed: Missed,
}

impl<const AXES: usize> MotionFilters<AXES> {
    /// A motion of which one sample is known. It is large, and rarely begins.
    #[inline(never)]
    pub fn new(value: &SVector<f64, AXES>, time_us: u64) -> Self {
        Self { filters: [MotionFilter::new(value); BANDWIDTHS_RAD_S.len()], time_us }
    }

    /// Another origin: as if all samples had been elsewhere.
    pub fn shift(&mut self, by: &SVector<f64, AXES>) {
        self.filters.iter_mut().for_each(|filter| filter.state[0] += by);
    }

    /// The next sample.
    pub fn observe(&mut self, value: &SVector<f64, AXES>, time_us: u64) {
        let elapsed_s = seconds(self.time_us, time_us);
        for (filter, bandwidth_rad_s) in self.filters.iter_mut().zip(BANDWIDTHS_RAD_S) {
            filter.observe(value, bandwidth_rad_s * elapsed_s, elapsed_s);
        }
        self.time_us = time_us;
    }

    /// Mean square of what the predictions of the best filter have missed lately; infinite until there are some.
    pub fn missed(&self) -> f64 {
        self.filters.iter().map(|filter| filter.missed.mean_square()).fold(f64::INFINITY, f64::min)
    }

    /// Value and derivatives at a time, as all filters tell them together. Which one has missed least may change from sample to sample, so
    /// none is chosen: see [`CHOOSY`].
    pub fn at(&self, time_us: u64) -> Rows<AXES> {
        let (elapsed_s, least) = (seconds(self.time_us, time_us), self.missed());
        let (mut sum, mut weights) = ([SVector::zeros(); ORDERS], 0.0);
        for (filter, bandwidth_rad_s) in self.filters.iter().zip(BANDWIDTHS_RAD_S) {
            let weight = filter.weight(least);
            weights += weight;
            let mut scale = weight;
            for (sum, derivative) in sum.iter_mut().zip(moved_on(&filter.state, bandwidth_rad_s * elapsed_s))
            {
                *sum += derivative * scale;
                scale *= bandwidth_rad_s;
            }
        }
        sum.map(|sum| sum / weights)
    }
}

impl<const AXES: usize> MotionFilter<AXES> {
    fn new(value: &SVector<f64, AXES>) -> Self {
        let mut state = [SVector::zeros(); ORDERS];
        state[0] = *value;
        let variance = |order| if order == 0 { 1.0 } else { UNKNOWN };
        let covariance =
            core::array::from_fn(|i| SVector::from_fn(|j, _| if i == j { variance(i) } else { 0.0 }));
        Self { state, covariance, missed: Missed::default() }
    }

    /// How much it counts where the best filter has missed a mean square.
    fn weight(&self, least: f64) -> f64 {
        let missed = self.missed.mean_square();
        // Where nothing was missed, or nothing was foretold, all that are as good count alike.
        if missed == least { 1.0 } else { libm::pow(least / missed, CHOOSY) }
    }

    fn observe(&mut self, value: &SVector<f64, AXES>, tau: f64, elapsed_s: f64) {
        self.state = moved_on(&self.state, tau);
        self.covariance = symmetric(&moved_on(&transposed(&moved_on(&self.covariance, tau)), tau));
        add_driven(&mut self.covariance, tau);

        let missed = value - self.state[0];
        let column = self.covariance[0];
        let variance = column[0] + 1.0;
        if variance < TELLING {
            self.missed.observe(missed.norm_squared(), elapsed_s);
        }
        for (order, (state, row)) in self.state.iter_mut().zip(&mut self.covariance).enumerate() {
            let gain = column[order] / variance;
            *state += missed * gain;
            *row -= column * gain;
        }
    }
}

/// Φ times a matrix, by Horner's scheme.
fn moved_on<const COLUMNS: usize>(rows: &Rows<COLUMNS>, tau: f64) -> Rows<COLUMNS> {
    core::array::from_fn(|order| {
        let higher = rows.iter().enumerate().skip(order).rev();
        higher.fold(SVector::zeros(), |sum, (place, row)| row + sum * (tau / (place + 1 - order) as f64))
    })
}

fn transposed(rows: &Rows<ORDERS>) -> Rows<ORDERS> {
    core::array::from_fn(|i| SVector::from_fn(|j, _| rows[j][i]))
}

/// Rounding, which would grow from sample to sample, makes no difference between P and Pᵀ.
fn symmetric(rows: &Rows<ORDERS>) -> Rows<ORDERS> {
    let other = transposed(rows);
    core::array::from_fn(|i| (rows[i] + other[i]) / 2.0)
}

/// Adds Q.
fn add_driven(covariance: &mut Rows<ORDERS>, tau: f64) {
    const FACTORIALS: [f64; ORDERS] = [1.0, 1.0, 2.0, 6.0, 24.0, 120.0];
    let mut powers = [1.0; 2 * ORDERS + 1];
    for order in 1..powers.len() {
        powers[order] = powers[order - 1] * tau;
    }
    for (i, row) in covariance.iter_mut().enumerate() {
        for (j, variance) in row.iter_mut().enumerate() {
            let divisor =
                FACTORIALS[ORDERS - 1 - i] * FACTORIALS[ORDERS - 1 - j] * (2 * ORDERS - 1 - i - j) as f64;
            *variance += powers[2 * ORDERS - i - j] / divisor;
        }
    }
}

fn seconds(since_us: u64, time_us: u64) -> f64 {
    time_us.saturating_sub(since_us) as f64 / 1e6
}

/// How long, s, what was missed is remembered.
const REMEMBERED_S: f64 = 1.5;

/// A mean of the squares of what predictions have missed, of which the older ones count less.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
struct Missed {
    sum: f64,
    weight: f64,
}

impl Missed {
    /// The square of what the prediction of a sample has missed, so long after the sample before.
    fn observe(&mut self, square: f64, elapsed_s: f64) {
        let kept = libm::exp(-elapsed_s / REMEMBERED_S);
        (self.sum, self.weight) = (self.sum * kept + square, self.weight * kept + 1.0);
    }

    /// Infinite until there was a prediction.
    fn mean_square(&self) -> f64 {
        if self.weight > 0.0 { self.sum / self.weight } else { f64::INFINITY }
    }
}

#[cfg(test)]
mod tests {
    use core::f64::consts::PI;

    use nalgebra::{Vector1, Vector3};

    use super::{BANDWIDTHS_RAD_S, MotionFilters, ORDERS};
    use crate::guidance::known_motion;

    /// The oracle is the polynomial itself: of fifth degree, and so a motion that every filter supposes to be possible.
    #[test]
    fn exact_samples_of_a_polynomial_tell_all_of_it() {
        let coefficients = [0.3, -1.1, 0.7, 0.4, -0.2, 0.05];
        let derivative = |order: usize, t: f64| -> f64 {
            let falling = |power: usize| (0..order).map(|less| (power - less) as f64).product::<f64>();
            (order..ORDERS)
                .map(|power| coefficients[power] * falling(power) * t.powi((power - order) as i32))
                .sum()
        };
        let at = |step: u64| step as f64 * 0.1;
        let mut filters = MotionFilters::new(&Vector1::new(derivative(0, 0.0)), 0);
        for step in 1..=100 {
            filters.observe(&Vector1::new(derivative(0, at(step))), step * 100_000);
        }
        for (order, told) in filters.at(10_050_000).iter().enumerate() {
            let expected = derivative(order, 10.05);
            assert!((told.x / expected - 1.0).abs() < 1e-3, "{order}: {} {expected}", told.x);
        }
    }

    /// Of ever more frequent samples the filter is that of Kalman and Bucy, whose poles for a driven sixth derivative are those of
    /// Butterworth: the gain of the value is the sum of the poles, b/sin(π/12), which is P₀₀ by the time between two samples.
    #[test]
    fn poles_are_those_of_butterworth() {
        let mut filters = MotionFilters::new(&Vector1::new(0.0), 0);
        for step in 1..=200_000 {
            filters.observe(&Vector1::new(0.0), step * 200);
        }
        for (filter, bandwidth_rad_s) in filters.filters.iter().zip(BANDWIDTHS_RAD_S).skip(2) {
            let gain = filter.covariance[0][0] / 200e-6 / bandwidth_rad_s;
            assert!((gain * (PI / 12.0).sin() - 1.0).abs() < 0.01, "{bandwidth_rad_s}: {gain}");
        }
    }

    /// A circle of 5 m at 0.5 rad/s in positions that are rounded to 1.1 cm, ten times a second. Bars are parts of the size of each
    /// derivative; two samples alone are off by 4 % of the velocity, and three by 90 % of the acceleration.
    #[test]
    fn rounded_positions_tell_a_motion() {
        let whole = |step: u64| known_motion::circle(5.0, 0.5, step as f64 * 0.1);
        let rounded = |step: u64| whole(step).position_m.map(|value| (value / 0.011).round() * 0.011);
        let mut filters = MotionFilters::new(&rounded(0), 0);
        let mut squares = [0.0; 4];
        for step in 1..=400_u64 {
            filters.observe(&rounded(step), step * 100_000);
            if step > 100 {
                let told: [Vector3<f64>; ORDERS] = filters.at(step * 100_000);
                let known = whole(step);
                let known = [known.position_m, known.velocity_m_s, known.acceleration_m_s2, known.jerk_m_s3];
                for ((square, told), known) in squares.iter_mut().zip(told).zip(known) {
                    *square += (told - known).norm_squared() / known.norm_squared() / 300.0;
                }
            }
        }
        let off = squares.map(f64::sqrt);
        assert!(off.iter().zip([0.001, 0.01, 0.1, 0.4]).all(|(off, bar)| *off < bar), "{off:?}");
    }
}
