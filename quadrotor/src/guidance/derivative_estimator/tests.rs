//! Signals whose derivatives are known, sampled as importers and clients set them.

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
            assert!(errors[0].abs() < 0.05 && errors[1].abs() < 0.5, "{t} each {period_us} µs: {errors:?}");
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
        _ => inward * (3.0 * speed * a / RADIUS_M) - along * (speed * speed * speed / RADIUS_M / RADIUS_M),
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
                assert!(t < 1.0 || since < soon || off < 0.1, "{t} each {period_us} µs, {period_s} s: {off}");
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
