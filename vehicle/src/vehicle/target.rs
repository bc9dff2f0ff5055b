//! A target that is followed: what it tells of itself, and where it is between its reports.

use nalgebra::{Vector2, Vector3};

/// What a target tells of itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TargetReport {
    /// Where it is, NED, m.
    pub position_m: Vector3<f64>,
    /// Its velocity, NED, m/s, if it tells it.
    pub velocity_m_s: Option<Vector3<f64>>,
    /// Its acceleration, NED, m/s², if it tells it.
    pub acceleration_m_s2: Option<Vector3<f64>>,
    /// Its heading, rad, if it tells it.
    pub heading_rad: Option<f64>,
}

/// How much news counts against what was expected, 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trust {
    /// Of the position.
    pub position: f64,
    /// Of the velocity.
    pub velocity: f64,
    /// Reports nearer together than this, s, tell nothing new.
    pub nearest_apart_s: f64,
}

/// A target as it moves on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// When it reported, µs.
    reported_us: u64,
    position_m: Vector3<f64>,
    velocity_m_s: Vector3<f64>,
    acceleration_m_s2: Vector3<f64>,
    /// Where it goes, once that is known, rad.
    course_rad: Option<f64>,
    heading_rad: Option<f64>,
    /// The place that its velocity was last found from, as it was told, m, and when, µs.
    told_m: Vector3<f64>,
    told_us: u64,
    /// The velocity that it told then, m/s, if it did.
    told_m_s: Option<Vector3<f64>>,
}

/// A target at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TargetMotion {
    /// NED, m.
    pub position_m: Vector3<f64>,
    /// NED, m/s.
    pub velocity_m_s: Vector3<f64>,
    /// NED, m/s².
    pub acceleration_m_s2: Vector3<f64>,
    /// Where it goes, rad, once that is known.
    pub course_rad: Option<f64>,
    /// Where its nose points, rad, if it tells that; else where it goes.
    pub heading_rad: Option<f64>,
    /// How fast it turns, rad/s.
    pub turn_rate_rad_s: f64,
}

/// Slower than this, m/s, a target has no course of its own: it keeps the last one.
const COURSE_M_S: f64 = 0.3;
/// A target that tells no velocity and comes along faster than this, m/s, travels.
const TRAVELS_M_S: f64 = 0.5;
/// An acceleration is trusted for so long, s; then the target goes on evenly.
const ACCELERATION_S: f64 = 1.5;
/// Reports farther apart than this, s, tell nothing of what was between them.
const FARTHEST_APART_S: f64 = 5.0;
/// Places nearer together than this, s, tell no velocity, as in PX4.
const VELOCITY_APART_S: f64 = 0.5;
/// The same place and velocity within this time, s, are the same report: clients send their last one again.
const REPEATED_S: f64 = 1.0;
/// The largest acceleration, m/s², that is believed.
const STRONGEST_M_S2: f64 = 4.0;
/// Changes of velocity are smoothed over this time, s.
const SMOOTHING_S: f64 = 0.3;
/// A report that is farther than this, m, from what was expected begins anew.
const JUMP_M: f64 = 20.0;

impl Target {
    /// A target that reports for the first time, at a time, µs.
    pub fn new(report: &TargetReport, time_us: u64) -> Self {
        let mut target = Self {
            reported_us: time_us,
            position_m: report.position_m,
            velocity_m_s: report.velocity_m_s.unwrap_or_default(),
            acceleration_m_s2: report.acceleration_m_s2.unwrap_or_default(),
            course_rad: None,
            heading_rad: report.heading_rad,
            told_m: report.position_m,
            told_us: time_us,
            told_m_s: report.velocity_m_s,
        };
        target.find_course();
        target
    }

    /// Takes the next report in.
    pub fn update(&mut self, report: &TargetReport, trust: &Trust, time_us: u64) {
        let seconds_since = |then_us: u64| time_us.saturating_sub(then_us) as f64 / 1e6;
        let (apart_s, told_apart_s) = (seconds_since(self.reported_us), seconds_since(self.told_us));
        let repeated = report.position_m == self.told_m && report.velocity_m_s == self.told_m_s;
        if repeated && told_apart_s < REPEATED_S {
            return;
        }
        let expected = self.at(time_us);
        let surprise = report.position_m - expected.position_m;
        if apart_s > FARTHEST_APART_S || surprise.norm() > JUMP_M {
            *self = Self::new(report, time_us);
            return;
        }
        if apart_s < trust.nearest_apart_s {
            return;
        }
        // Programs that do not know it tell zeros, too: a target that travels is not at rest.
        let travelled = (report.position_m - self.told_m) / told_apart_s;
        let rests = |told: &Vector3<f64>| *told == Vector3::zeros() && travelled.norm() > TRAVELS_M_S;
        let told = report.velocity_m_s.filter(|told| !rests(told));
        let velocity_m_s = match told {
            Some(told) => expected.velocity_m_s + (told - expected.velocity_m_s) * trust.velocity,
            // From place to place.
            None if told_apart_s >= VELOCITY_APART_S => {
                self.velocity_m_s + (travelled - self.velocity_m_s) * trust.velocity
            }
            None => self.velocity_m_s,
        };
        if told.is_some() || told_apart_s >= VELOCITY_APART_S {
            (self.told_m, self.told_us) = (report.position_m, time_us);
            self.told_m_s = report.velocity_m_s;
        }
        let felt = (velocity_m_s - self.velocity_m_s) / apart_s;
        let share = apart_s / (SMOOTHING_S + apart_s);
        let smoothed = self.acceleration_m_s2 + (felt - self.acceleration_m_s2) * share;
        // Places alone are too coarse to tell an acceleration.
        let derived = if told.is_some() { smoothed } else { Vector3::zeros() };
        *self = Self {
            reported_us: time_us,
            position_m: expected.position_m + surprise * trust.position,
            velocity_m_s,
            acceleration_m_s2: report.acceleration_m_s2.unwrap_or(derived).cap_magnitude(STRONGEST_M_S2),
            course_rad: self.course_rad,
            heading_rad: report.heading_rad,
            ..*self
        };
        self.find_course();
    }

    fn find_course(&mut self) {
        let v = self.velocity_m_s;
        if v.xy().norm() > COURSE_M_S {
            self.course_rad = Some(libm::atan2(v.y, v.x));
        }
    }

    /// How old its last report is at a time, s.
    pub fn age_s(&self, time_us: u64) -> f64 {
        time_us.saturating_sub(self.reported_us) as f64 / 1e6
    }

    /// Where it is at a time, µs, as far as it can be told.
    pub fn at(&self, time_us: u64) -> TargetMotion {
        let age_s = self.age_s(time_us);
        let t = age_s.min(ACCELERATION_S);
        let rest_s = age_s - t;
        let (v, a) = (self.velocity_m_s, self.acceleration_m_s2);
        let then = v + a * t;
        let turn_rate_rad_s = if rest_s > 0.0 { 0.0 } else { turn_rate_rad_s(&v.xy(), &a.xy()) };
        let turned_rad = turn_rate_rad_s * t;
        let moving = then.xy().norm() > COURSE_M_S;
        let course_rad = if moving { Some(libm::atan2(then.y, then.x)) } else { self.course_rad };
        TargetMotion {
            position_m: self.position_m + (v + a * (t / 2.0)) * t + then * rest_s,
            velocity_m_s: then,
            acceleration_m_s2: if rest_s > 0.0 { Vector3::zeros() } else { a },
            course_rad,
            heading_rad: self.heading_rad.map(|heading_rad| heading_rad + turned_rad).or(course_rad),
            turn_rate_rad_s,
        }
    }
}

/// ω = (v × a) / v², rad/s.
fn turn_rate_rad_s(v: &Vector2<f64>, a: &Vector2<f64>) -> f64 {
    let squared = v.norm_squared();
    if squared > COURSE_M_S * COURSE_M_S { (v.x * a.y - v.y * a.x) / squared } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::{Target, TargetReport, Trust};

    const TRUST: Trust = Trust { position: 0.9, velocity: 0.9, nearest_apart_s: 0.1 };

    /// A target on a circle, 5 m/s at 0.2 rad/s.
    fn on_circle(time_s: f64) -> TargetReport {
        let (sin, cos) = (0.2 * time_s).sin_cos();
        TargetReport {
            position_m: Vector3::new(25.0 * sin, 25.0 * (1.0 - cos), 0.0),
            velocity_m_s: Some(Vector3::new(5.0 * cos, 5.0 * sin, 0.0)),
            acceleration_m_s2: None,
            heading_rad: None,
        }
    }

    #[test]
    fn between_reports_of_a_second_it_is_known_to_half_a_metre() {
        let mut target = Target::new(&on_circle(0.0), 0);
        for second in 1..30_u64 {
            for tenth in 0..10 {
                let time_us = (second - 1) * 1_000_000 + tenth * 100_000;
                let there = on_circle(time_us as f64 / 1e6).position_m;
                let off_m = (target.at(time_us).position_m - there).norm();
                assert!(second < 4 || off_m < 0.5, "{off_m} m off at {second} s");
            }
            target.update(&on_circle(second as f64), &TRUST, second * 1_000_000);
        }
        assert!((target.at(29_000_000).turn_rate_rad_s - 0.2).abs() < 0.03);
    }

    /// MAVSDK sends what it was told at once, and once more with the beat of a clock of its own.
    #[test]
    fn reports_in_quick_succession_make_nothing_of_their_noise() {
        let noise = [0.8, -1.1, 0.3, -0.6, 1.4, -0.2, 0.9, -1.3];
        let report = |second: u64, more_m: f64| TargetReport {
            position_m: Vector3::new(2.0 * second as f64 + noise[second as usize % 8] + more_m, 0.0, 0.0),
            velocity_m_s: None,
            acceleration_m_s2: None,
            heading_rad: None,
        };
        let mut target = Target::new(&report(0, 0.0), 0);
        for second in 1..20 {
            let time_us = second * 1_000_000;
            target.update(&report(second, 0.0), &TRUST, time_us);
            let before = target;
            target.update(&report(second, 0.0), &TRUST, time_us + 700_000);
            assert_eq!(target, before, "the same place");
            target.update(&report(second, 0.5), &TRUST, time_us + 20_000);
            assert_eq!(target, before, "too soon");
            target.update(&report(second, 0.5), &TRUST, time_us + 200_000);
            let motion = target.at(time_us + 1_000_000);
            assert!((motion.velocity_m_s.x - 2.0).abs() < 3.0, "{second} s: {motion:?}");
            assert!((motion.position_m.x - 2.0 * (second + 1) as f64).abs() < 4.0, "{second} s: {motion:?}");
        }
    }

    #[test]
    fn without_a_velocity_it_is_found_from_place_to_place() {
        // Nor with one of zeros.
        for velocity_m_s in [None, Some(Vector3::zeros())] {
            let report = |second: u64| TargetReport {
                position_m: Vector3::new(0.0, 3.0 * second as f64, 0.0),
                velocity_m_s,
                acceleration_m_s2: None,
                heading_rad: None,
            };
            let mut target = Target::new(&report(0), 0);
            assert_eq!(target.at(0).course_rad, None);
            for second in 1..10 {
                target.update(&report(second), &TRUST, second * 1_000_000);
            }
            let motion = target.at(9_500_000);
            assert!((motion.velocity_m_s.y - 3.0).abs() < 0.01 && (motion.position_m.y - 28.5).abs() < 0.1);
            assert!((motion.course_rad.unwrap() - core::f64::consts::FRAC_PI_2).abs() < 1e-6);
        }
    }
}
