//! Derivatives of a trajectory that nobody gives.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::guidance::derivative_estimator::{DerivativeEstimator, Derivatives, Sample};
use crate::guidance::motion_filters::MotionFilters;
use crate::guidance::streamed_velocity::StreamedVelocity;
use crate::{GRAVITY_M_S2, Limits, PositionReference};

/// How many times the limits of tilt rate and tilt acceleration are taken for motion.
const MOTION: f64 = 1.5;
/// So many samples tell the derivatives of a motion well.
const SETTLED: usize = 9;
/// Derivatives that are told so well may be so many times as large: a path may be far beyond the limits. Cut off, they would not be those of
/// one motion, and nobody would see how much of the path to leave out.
const FAR_BEYOND: f64 = 4.0;
/// Multiple of the limits of jerk beyond which a change of the acceleration counts as a jump, not as motion.
const JERK_JUMP: f64 = 10.0;
/// The same of the limits of speed for a change of the position.
const SPEED_JUMP: f64 = 3.0;

/// What is known of the derivatives of points of which only positions are given, or positions and velocities, or no jerk and snap:
/// the derivatives above the highest one that is given, from its samples. What is zero is not given. A constant has no derivatives, so
/// that set-points and straight lines stay what they are.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct FoundDerivatives {
    positions: DerivativeEstimator<3>,
    velocities: StreamedVelocity,
    accelerations: DerivativeEstimator<3>,
    /// Beside the samples of positions or velocities. Accelerations change in steps, which are no noise.
    filters: MotionFilters<3>,
    filtered: Signal,
}

/// What is given of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
enum Signal {
    Position,
    Velocity,
}

impl FoundDerivatives {
    /// Nothing is known.
    pub fn new() -> Self {
        Self {
            positions: DerivativeEstimator::new(),
            velocities: StreamedVelocity::default(),
            accelerations: DerivativeEstimator::new(),
            filters: MotionFilters::new(&Vector3::zeros(), 0),
            filtered: Signal::Position,
        }
    }

    /// Looks at a point, more often than it is sampled: derivatives are found from the instants at which points are set.
    pub fn watch(&mut self, point: &PositionReference, limits: &Limits, time_us: u64) {
        let moves = is_given(&point.velocity_m_s);
        let bends = is_given(&point.acceleration_m_s2);
        if gives_all(point) {
            self.accelerations.forget();
        } else {
            let fastest = JERK_JUMP * limits.jerk_horizontal_m_s3.max(limits.jerk_vertical_m_s3);
            self.accelerations.observe(&point.acceleration_m_s2, fastest, time_us);
        }
        if bends || gives_all(point) {
            self.velocities.forget();
        } else {
            let sample = self.velocities.look(&point.velocity_m_s, limits, time_us);
            self.filter(Signal::Velocity, sample, &point.velocity_m_s, time_us);
        }
        if moves || bends || gives_all(point) {
            self.positions.forget();
        } else {
            let fastest = limits.speed_horizontal_m_s.max(limits.speed_up_m_s).max(limits.speed_down_m_s);
            let sample = self.positions.observe(&point.position_m, SPEED_JUMP * fastest, time_us);
            self.filter(Signal::Position, sample, &point.position_m, time_us);
        }
    }

    /// The positions are elsewhere, m, but the motion is the same.
    pub fn shift(&mut self, by_m: &Vector3<f64>) {
        self.positions.shift(by_m);
        if self.filtered == Signal::Position {
            self.filters.shift(by_m);
        }
    }

    /// The filters go on with a sample, or with another motion.
    fn filter(&mut self, signal: Signal, sample: Sample, value: &Vector3<f64>, time_us: u64) {
        match sample {
            Sample::None => {}
            Sample::Next if self.filtered == signal => self.filters.observe(value, time_us),
            Sample::First | Sample::Next => {
                (self.filtered, self.filters) = (signal, MotionFilters::new(value, time_us));
            }
        }
    }

    /// A signal without its noise, and its derivatives, at a time.
    fn told(
        &self,
        (signal, estimator): (Signal, &DerivativeEstimator<3>),
        value: &Vector3<f64>,
        time_us: u64,
    ) -> (Vector3<f64>, Derivatives<3>) {
        if self.filtered == signal && estimator.is_told_as_well(self.filters.missed()) {
            let [value, first, second, third, fourth, _] = self.filters.at(time_us);
            return (value, Derivatives { first, second, third, fourth });
        }
        (*value, estimator.at(time_us))
    }

    /// Whether the acceleration of a point is found from many samples. From a few it is only rough.
    pub fn are_settled(&self, point: &PositionReference) -> bool {
        let samples = self.positions.samples().max(self.velocities.samples());
        !gives_all(point) && !is_given(&point.acceleration_m_s2) && samples >= SETTLED
    }

    /// A point that was set at `since_us` with the derivatives that it lacks, as far as they are known.
    pub fn completed(&self, point: &PositionReference, limits: &Limits, since_us: u64) -> PositionReference {
        if gives_all(point) {
            return *point;
        }
        // What the tilt command may do, and what is motion beyond it.
        let most = if self.are_settled(point) { FAR_BEYOND } else { 1.0 } * GRAVITY_M_S2;
        let most_m_s2 = most * libm::tan(limits.tilt_rad);
        let most_m_s3 = most * MOTION * limits.tilt_rate_rad_s;
        let most_m_s4 = most * MOTION * limits.tilt_acceleration_rad_s2;
        let mut whole = *point;
        let found = self.accelerations.at(since_us);
        whole.jerk_m_s3 = at_most(&found.first, most_m_s3);
        whole.snap_m_s4 = at_most(&found.second, most_m_s4);
        if is_given(&point.acceleration_m_s2) {
            return whole;
        }
        // A velocity may be zero where a motion turns.
        let velocities = (Signal::Velocity, self.velocities.estimator());
        let (velocity_m_s, found) = self.told(velocities, &point.velocity_m_s, since_us);
        if is_given(&point.velocity_m_s) || is_given(&found.first) {
            whole.velocity_m_s = velocity_m_s;
            whole.acceleration_m_s2 = at_most(&found.first, most_m_s2);
            whole.jerk_m_s3 += at_most(&found.second, most_m_s3);
            whole.snap_m_s4 += at_most(&found.third, most_m_s4);
        } else {
            let positions = (Signal::Position, &self.positions);
            let (position_m, found) = self.told(positions, &point.position_m, since_us);
            whole.position_m = position_m;
            whole.velocity_m_s = found.first;
            whole.acceleration_m_s2 = at_most(&found.second, most_m_s2);
            whole.jerk_m_s3 = at_most(&found.third, most_m_s3);
            whole.snap_m_s4 = at_most(&found.fourth, most_m_s4);
        }
        whole
    }
}

/// A vector that is shortened to a largest length above zero. It never divides by the length of a zero vector, not even where
/// the compiler computes both cases.
fn at_most(vector: &Vector3<f64>, largest: f64) -> Vector3<f64> {
    vector * (largest / vector.norm().max(largest))
}

fn is_given(derivative: &Vector3<f64>) -> bool {
    *derivative != Vector3::zeros()
}

/// Whether jerk and snap are given with a point.
pub(crate) fn gives_all(point: &PositionReference) -> bool {
    is_given(&point.jerk_m_s3) || is_given(&point.snap_m_s4)
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::FoundDerivatives;
    use crate::guidance::known_motion::{self, motion};
    use crate::{Limits, PositionReference};

    /// A point of a circle of 5 m at 0.5 rad/s with so many of its derivatives.
    fn circle(t: f64, derivatives: i32) -> PositionReference {
        let whole = known_motion::circle(5.0, 0.5, t);
        let all =
            [whole.position_m, whole.velocity_m_s, whole.acceleration_m_s2, whole.jerk_m_s3, whole.snap_m_s4];
        motion(|order| if order <= derivatives { all[order as usize] } else { Vector3::zeros() })
    }

    /// The points of a signal that is set each `period_us` for 6 s, as they are given and with what is found: time, s, and both.
    fn completed(
        signal: impl Fn(f64) -> PositionReference,
        period_us: u64,
    ) -> impl Iterator<Item = (f64, PositionReference, PositionReference)> {
        let (limits, mut found) = (Limits::default(), FoundDerivatives::new());
        (0..6_000_u64).filter_map(move |millisecond| {
            let time_us = millisecond * 1_000;
            let set_us = time_us / period_us * period_us;
            let point = signal(set_us as f64 * 1e-6);
            found.watch(&point, &limits, time_us);
            (set_us == time_us)
                .then(|| (set_us as f64 * 1e-6, point, found.completed(&point, &limits, set_us)))
        })
    }

    /// The oracle is the circle itself. Each derivative that is found has a part of its size as a bar.
    #[test]
    fn two_derivatives_of_a_circle_are_found_above_the_last_one() {
        for period_us in [10_000, 20_000, 50_000, 100_000] {
            for given in [0, 1, 2] {
                for (t, _, found) in completed(|t| circle(t, given), period_us).filter(|(t, ..)| *t > 1.0) {
                    let whole = circle(t, 4);
                    let off = [
                        (found.velocity_m_s - whole.velocity_m_s).norm() / 2.5,
                        (found.acceleration_m_s2 - whole.acceleration_m_s2).norm() / 1.25,
                        (found.jerk_m_s3 - whole.jerk_m_s3).norm() / 0.625,
                        (found.snap_m_s4 - whole.snap_m_s4).norm() / 0.3125,
                    ];
                    let next = given as usize;
                    assert!(
                        off[next] < 0.01 && off[next + 1] < 0.05,
                        "{given} each {period_us} µs: {t} {off:?}"
                    );
                }
            }
        }
    }

    /// Positions alone tell all derivatives of a smooth motion, also few of them. Bars are parts of the size of each.
    #[test]
    fn positions_tell_all_derivatives_of_a_smooth_motion() {
        for (period_us, bars) in
            [(20_000, [0.01; 4]), (50_000, [0.01; 4]), (100_000, [0.001, 0.003, 0.02, 0.2])]
        {
            for (t, _, found) in completed(|t| circle(t, 0), period_us).filter(|(t, ..)| *t > 1.0) {
                let whole = circle(t, 4);
                let off = [
                    (found.velocity_m_s - whole.velocity_m_s).norm() / 2.5,
                    (found.acceleration_m_s2 - whole.acceleration_m_s2).norm() / 1.25,
                    (found.jerk_m_s3 - whole.jerk_m_s3).norm() / 0.625,
                    (found.snap_m_s4 - whole.snap_m_s4).norm() / 0.3125,
                ];
                let within = off.iter().zip(bars).all(|(off, bar)| *off < bar);
                assert!(within, "each {period_us} µs: {t} {off:?}");
            }
        }
    }

    /// Behind a corner, jerk and snap are not made up: a speed of 2 m/s that begins to fall by 2 m/s².
    #[test]
    fn a_corner_has_no_jerk() {
        let braked = |t: f64| {
            let braking_s = (t - 3.0).clamp(0.0, 1.0);
            PositionReference::goal([2.0 * t.min(4.0) - braking_s * braking_s, 0.0, 0.0], 0.0)
        };
        for period_us in [20_000, 50_000, 100_000] {
            for (t, _, found) in completed(braked, period_us) {
                let made_up = found.jerk_m_s3.norm() + found.snap_m_s4.norm();
                assert!(made_up < 1e-3, "each {period_us} µs: {t} {found:?}");
            }
        }
    }

    /// Set-points that jump, stairs, straight lines, and points with all derivatives.
    #[test]
    fn what_lacks_nothing_stays_as_it_is() {
        let goals =
            |t: f64| PositionReference::goal([libm::floor(t), -2.0 * libm::floor(t / 2.0), -5.0], 0.0);
        let stairs = |t: f64| PositionReference::goal([0.2 * libm::floor(t / 0.4), 0.0, 0.0], 0.0);
        let line = |t: f64| PositionReference {
            velocity_m_s: Vector3::new(1.5, -0.7, 0.2),
            ..PositionReference::goal([1.5 * t, -0.7 * t, 0.2 * t], 0.0)
        };
        let whole = |t: f64| circle(t, 4);
        let signals: [&dyn Fn(f64) -> PositionReference; 4] = [&goals, &stairs, &line, &whole];
        for (kind, signal) in signals.into_iter().enumerate() {
            for period_us in [1_000, 50_000] {
                for (t, given, found) in completed(signal, period_us) {
                    assert_eq!(given, found, "{kind} each {period_us} µs: {t}");
                }
            }
        }
    }
}
