//! A reference far beyond the limits, narrowed about its middle.

use nalgebra::{Vector2, Vector3};
use serde::{Deserialize, Serialize};

use crate::control::demand::asked;
use crate::{Configuration, PositionReference};

/// With a smaller share of the horizontal motion than that, what is followed leaves room for the feedback.
const NARROW: f64 = 0.9;
/// Rates, 1/s, at which what is asked for counts and is forgotten: what lasts for less than a second is no way.
const NOTICED_1_S: f64 = 1.0;
const FORGOTTEN_1_S: f64 = 0.15;
/// More than what counts by this share of it is far beyond, and how much faster that is noticed, by the square of what it is more. Noticed as
/// slowly as the rest, a small and fast swing would turn the vehicle over first. Derivatives that are found have noise, which is no way.
const FAR: f64 = 0.3;
const FASTER: f64 = 100.0;
/// The fastest that it is noticed, 1/s.
const FASTEST_1_S: f64 = 30.0;
/// Rate, 1/s, at which the share follows what is asked for. It is a double pole, so that acceleration and jerk do not jump.
const SHARE_1_S: f64 = 6.0;
/// Motions slower than this, rad/s, are followed whole: the middle of the way is where the reference is in the mean.
const MIDDLE_RAD_S: f64 = 0.5;
/// A way so near to its reference, m, is the reference.
const NEAR_M: f64 = 0.01;
/// And so slow beside it, m/s: on a line, the way crosses its reference at speed.
const NEAR_M_S: f64 = 0.01;
/// The longest step of time, s; after a longer one the way goes on from there.
const STEP_S: f64 = 0.1;

/// What is followed of a reference that asks for far more than the limits of lean, tilt rate and tilt acceleration, or of the thrust: a way of
/// the same shape, narrowed about its middle to a share κ of its size. The offset δ from the reference r is
///
/// ```text
/// δ = (s + 3ω) x,  (s + ω)³ x = −(1 − κ) r̈
/// ```
///
/// κ is such that what is followed asks for about [`FOLLOWED`](crate::control::demand::FOLLOWED) times the limits, and for less than the
/// rotors can turn the vehicle. δ is −(1 − κ) r of motions that are fast against ω, and nothing of a
/// constant velocity. It is bounded as r is, whatever κ does: no feedback has to win over a saturation. The horizontal motion and the
/// vertical one have a share each.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct NarrowedWay {
    /// `None` while the reference is followed itself.
    narrowing: Option<Narrowing>,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Narrowing {
    /// Size of what was asked for lately as a multiple of what is followed as it is, of the horizontal motion and of the vertical one.
    asked: Vector2<f64>,
    /// κ of the horizontal motion and of the vertical one, and its derivatives.
    share: [Vector2<f64>; 3],
    /// x and its derivatives, up to the fourth.
    filter: [Vector3<f64>; 5],
    time_us: u64,
}

impl NarrowedWay {
    /// Whether so little of the horizontal motion is followed that it leaves room within the limits.
    pub(crate) fn is_narrow(&self) -> bool {
        self.narrowing.is_some_and(|narrowing| narrowing.share[0].x < NARROW)
    }

    /// Goes on to a reference at a time, µs, with an angular acceleration of roll and pitch that the rotors have in hover, rad/s². What
    /// is followed then, unless it is the reference itself. Beside the reference it is told whether its derivatives are, or only found.
    pub(crate) fn follow(
        &mut self,
        configuration: &Configuration,
        available_rad_s2: f64,
        (reference, is_told): (&PositionReference, bool),
        time_us: u64,
    ) -> Option<PositionReference> {
        if reference.is_at_rest() {
            self.narrowing = None;
            return None;
        }
        let vertical_share = self.narrowing.map_or(1.0, |narrowing| narrowing.share[0].y);
        let asked = asked(configuration, available_rad_s2, reference, vertical_share);
        let mut narrowing = match self.narrowing {
            None if asked.max() > 1.0 => Narrowing::none(time_us),
            None => return None,
            Some(narrowing) => narrowing.after((asked, is_told), time_us),
        };
        narrowing.drive(reference);
        let way = narrowing.beside(reference);
        let away_m = (way.position_m - reference.position_m).norm();
        let apart_m_s = (way.velocity_m_s - reference.velocity_m_s).norm();
        let ends =
            narrowing.asked.max() <= 1.0 && asked.max() <= 1.0 && away_m < NEAR_M && apart_m_s < NEAR_M_S;
        self.narrowing = (!ends && away_m.is_finite()).then_some(narrowing);
        self.narrowing.map(|_| way)
    }
}

/// The rate, 1/s, at which so many times as much as counts is noticed.
fn noticed_1_s(times: f64) -> f64 {
    let far = (times - 1.0 - FAR).max(0.0);
    (NOTICED_1_S * (1.0 + FASTER * far * far)).min(FASTEST_1_S)
}

/// Of the horizontal motion for north and east, of the vertical one for down.
fn each(of: &Vector2<f64>) -> Vector3<f64> {
    Vector3::new(of.x, of.x, of.y)
}

impl Narrowing {
    fn none(time_us: u64) -> Self {
        let (none, whole) = (Vector2::zeros(), Vector2::repeat(1.0));
        Self { asked: whole, share: [whole, none, none], filter: [Vector3::zeros(); 5], time_us }
    }

    /// Later, when so much is asked for.
    fn after(&self, (asked, is_told): (Vector2<f64>, bool), time_us: u64) -> Self {
        let t = (time_us.saturating_sub(self.time_us) as f64 / 1e6).min(STEP_S);
        let asked = self.asked.zip_map(&asked, |before, now| {
            let rate_1_s = if now <= before {
                FORGOTTEN_1_S
            } else if is_told {
                noticed_1_s(now / before)
            } else {
                NOTICED_1_S
            };
            before + (now - before) * (rate_1_s * t)
        });
        let [share, rate, bend] = self.share;
        let (share, rate) = (share + (rate + bend * (t / 2.0)) * t, rate + bend * t);
        let wanted = asked.map(|asked| 1.0 / asked.max(1.0));
        let [x0, x1, x2, x3, x4] = self.filter;
        Self {
            asked,
            share: [share, rate, ((wanted - share) * SHARE_1_S - rate * 2.0) * SHARE_1_S],
            filter: [
                x0 + (x1 + (x2 / 2.0 + (x3 / 6.0 + x4 * (t / 24.0)) * t) * t) * t,
                x1 + (x2 + (x3 / 2.0 + x4 * (t / 6.0)) * t) * t,
                x2 + (x3 + x4 * (t / 2.0)) * t,
                x3,
                x4,
            ],
            time_us,
        }
    }

    /// u = −(1 − κ) r̈ and its derivative: x⃛ = u − 3ω ẍ − 3ω² ẋ − ω³ x.
    fn drive(&mut self, reference: &PositionReference) {
        const W: f64 = MIDDLE_RAD_S;
        let [u, du, _] = self.narrowed_by(reference);
        let [x0, x1, x2, ..] = self.filter;
        self.filter[3] = u - x2 * (3.0 * W) - x1 * (3.0 * W * W) - x0 * (W * W * W);
        self.filter[4] = du - self.filter[3] * (3.0 * W) - x2 * (3.0 * W * W) - x1 * (W * W * W);
    }

    /// −(1 − κ) r̈ and its two derivatives.
    fn narrowed_by(&self, reference: &PositionReference) -> [Vector3<f64>; 3] {
        let [a, j, s] = [reference.acceleration_m_s2, reference.jerk_m_s3, reference.snap_m_s4];
        let [share, rate, bend] = self.share.map(|of| each(&of));
        let less = share - Vector3::repeat(1.0);
        [
            a.component_mul(&less),
            j.component_mul(&less) + a.component_mul(&rate),
            s.component_mul(&less) + j.component_mul(&rate) * 2.0 + a.component_mul(&bend),
        ]
    }

    /// The narrowed way beside a reference.
    fn beside(&self, reference: &PositionReference) -> PositionReference {
        const W: f64 = MIDDLE_RAD_S;
        let [u, du, ddu] = self.narrowed_by(reference);
        let [x0, x1, x2, x3, _] = self.filter;
        // δ̈ = u − 3ω² ẋ − ω³ x
        let middle = |fast: Vector3<f64>, slow: Vector3<f64>| fast * (3.0 * W * W) + slow * (W * W * W);
        PositionReference {
            position_m: reference.position_m + x1 + x0 * (3.0 * W),
            velocity_m_s: reference.velocity_m_s + x2 + x1 * (3.0 * W),
            acceleration_m_s2: reference.acceleration_m_s2 + u - middle(x1, x0),
            jerk_m_s3: reference.jerk_m_s3 + du - middle(x2, x1),
            snap_m_s4: reference.snap_m_s4 + ddu - middle(x3, x2),
            ..*reference
        }
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;
    use core::f64::consts::FRAC_PI_2;

    use nalgebra::Vector3;

    use super::NarrowedWay;
    use crate::control::demand::tests::weaken;
    use crate::guidance::known_motion;
    use crate::{Configuration, GRAVITY_M_S2, PositionReference};

    const STEP_US: u64 = 1_000;
    /// Angular acceleration that the paper's airframe has in hover, rad/s².
    const AVAILABLE_RAD_S2: f64 = 8.5;

    /// A circle of 4 m.
    fn circle(rate_rad_s: f64, time_us: u64) -> PositionReference {
        known_motion::circle(4.0, rate_rad_s, 1e-6 * time_us as f64)
    }

    /// North and south at 1 rad/s, and up and down at another rate, each of a size, m.
    fn bobbing(north_m: f64, (down_m, rate_rad_s): (f64, f64), time_us: u64) -> PositionReference {
        known_motion::motion(|order| {
            let along = |size_m: f64, rate_rad_s: f64| {
                let angle = rate_rad_s * 1e-6 * time_us as f64 + f64::from(order) * FRAC_PI_2;
                size_m * rate_rad_s.powi(order) * libm::cos(angle)
            };
            Vector3::new(along(north_m, 1.0), 0.0, along(down_m, rate_rad_s))
        })
    }

    /// The ways beside a circle.
    fn ways(configuration: &Configuration, rate_rad_s: f64, steps: u64) -> Vec<PositionReference> {
        let mut way = NarrowedWay::default();
        (0..steps)
            .map(|step| {
                let reference = circle(rate_rad_s, step * STEP_US);
                way.follow(configuration, AVAILABLE_RAD_S2, (&reference, true), step * STEP_US)
                    .unwrap_or(reference)
            })
            .collect()
    }

    /// Each derivative is that of the one before, while the way narrows and afterwards.
    #[test]
    fn the_way_is_a_motion() {
        let ways = ways(&Configuration::default(), 3.0, 20_000);
        for (step, of_three) in ways.windows(3).enumerate().step_by(97) {
            let [before, now, after] = of_three else { unreachable!() };
            let slope = |of: fn(&PositionReference) -> Vector3<f64>| (of(after) - of(before)) / 2e-3;
            assert!((slope(|way| way.position_m) - now.velocity_m_s).norm() < 1e-3);
            assert!((slope(|way| way.velocity_m_s) - now.acceleration_m_s2).norm() < 1e-2);
            assert!((slope(|way| way.acceleration_m_s2) - now.jerk_m_s3).norm() < 0.1);
            // Of the 324 m/s⁴ of the circle. The third derivative of the share, which is settled within half a second, is left out.
            let snap = slope(|way| way.jerk_m_s3) - now.snap_m_s4;
            let most = if step < 500 { 75.0 } else { 5.0 };
            assert!(snap.norm() < most, "{step}: {snap}");
        }
    }

    /// At 3 rad/s the circle takes 36 m/s², six times the lean: κ is 1.3/6. Tilt rates of 2 rad/s are exceeded by 5.5 times, and 33 rad/s² are
    /// 4.3 times what is followed of the 8.5 rad/s² that the rotors have. By the transfer function 0.78 · 1.07 · 4 m are left out of it, and 0.99 of the lean are asked for.
    #[test]
    fn a_circle_far_beyond_is_narrowed_to_what_is_nearly_within() {
        let configuration = Configuration::default();
        let largest = libm::tan(0.91 * configuration.limits.tilt_rad) * GRAVITY_M_S2;
        for (step, way) in ways(&configuration, 3.0, 30_000).iter().enumerate().skip(20_000) {
            let leant = way.acceleration_m_s2.norm() / largest;
            assert!((0.95..1.05).contains(&leant), "{step}: {leant}");
            let away_m = (way.position_m - circle(3.0, step as u64 * STEP_US).position_m).norm();
            assert!((3.3..3.45).contains(&away_m), "{step}: {away_m} m");
        }
    }

    /// By tilt rate and tilt acceleration, too.
    #[test]
    fn turns_beyond_the_tilt_rate_are_narrowed() {
        let mut configuration = Configuration::default();
        configuration.limits.tilt_rate_rad_s = 0.3;
        let ways = ways(&configuration, 1.1, 30_000);
        let jerk = ways[29_999].jerk_m_s3.norm() / (GRAVITY_M_S2 * 0.3);
        assert!((1.1..1.4).contains(&jerk), "{jerk}");
    }

    /// Whatever the limits allow.
    #[test]
    fn turns_beyond_what_the_rotors_have_are_narrowed() {
        let mut configuration = Configuration::default();
        let limits = &mut configuration.limits;
        (limits.tilt_rad, limits.tilt_rate_rad_s, limits.tilt_acceleration_rad_s2) = (1.3, 100.0, 100.0);
        configuration.limits.thrust_max = 20.0;
        let ways = ways(&configuration, 2.6, 30_000);
        // 183 m/s⁴ of 75
        let snap = ways[29_999].snap_m_s4.norm() / (GRAVITY_M_S2 * AVAILABLE_RAD_S2);
        assert!((0.7..1.0).contains(&snap), "{snap}");
    }

    /// Rotors that make 2.4 weights have less room beside the thrust of the lean.
    #[test]
    fn less_of_a_turn_is_followed_where_it_takes_much_thrust() {
        let mut configuration = Configuration::default();
        let limits = &mut configuration.limits;
        (limits.tilt_rad, limits.tilt_rate_rad_s, limits.tilt_acceleration_rad_s2) = (1.3, 100.0, 100.0);
        limits.thrust_max = 20.0;
        let snap = |configuration: &Configuration| {
            ways(configuration, 2.6, 30_000)[29_999].snap_m_s4.norm() / (GRAVITY_M_S2 * AVAILABLE_RAD_S2)
        };
        let strong = snap(&configuration);
        weaken(&mut configuration);
        let weak = snap(&configuration);
        assert!(weak < 0.85 * strong && weak > 0.3, "{weak} {strong}");
    }

    /// Up and down by 0.1 m at 6 rad/s takes 3.6 m/s², of the 3.9 m/s² that the thrust allows. Level, it is followed as it is. A lean of 0.41 to
    /// the north would have to turn with 5.4 rad/s² beside it: 0.35 of 7.65 rad/s² is followed, half of it, but for how much of the time the
    /// lean is there.
    #[test]
    fn a_thrust_that_swings_at_a_lean_is_narrowed() {
        let configuration = Configuration::default();
        let swung = |north_m: f64| {
            let mut way = NarrowedWay::default();
            let mut largest_m_s2 = 0.0_f64;
            for step in 0..40_000 {
                let time_us = step * STEP_US;
                let reference = bobbing(north_m, (0.1, 6.0), time_us);
                let followed = way
                    .follow(&configuration, AVAILABLE_RAD_S2, (&reference, true), time_us)
                    .unwrap_or(reference);
                if step >= 20_000 {
                    largest_m_s2 = largest_m_s2.max(followed.acceleration_m_s2.z.abs());
                }
            }
            largest_m_s2
        };
        let (level_m_s2, leaning_m_s2) = (swung(0.01), swung(4.0));
        assert!((level_m_s2 - 3.6).abs() < 1e-3, "{level_m_s2}");
        assert!((0.45 * 3.6..0.75 * 3.6).contains(&leaning_m_s2), "{leaning_m_s2}");
    }

    /// Up and down by 1 m at 4 rad/s takes 16 m/s², of which a thrust of at least 0.6 of the weight leaves 3.9 down, and one of two weights 9.8
    /// up. A line to the north that the lean allows keeps its size. Followed is what falls no faster, but for the ripple of what was asked for
    /// lately, and so is not pushed up.
    #[test]
    fn the_vertical_motion_is_narrowed_by_itself() {
        let configuration = Configuration::default();
        let mut way = NarrowedWay::default();
        let (mut down_m_s2, mut up_m_s2, mut aside_m) = (0.0_f64, 0.0_f64, 0.0_f64);
        for step in 0..60_000 {
            let time_us = step * STEP_US;
            let reference = bobbing(4.0, (1.0, 4.0), time_us);
            let followed = way
                .follow(&configuration, AVAILABLE_RAD_S2, (&reference, true), time_us)
                .unwrap_or(reference);
            if step > 40_000 {
                aside_m = aside_m.max((followed.position_m - reference.position_m).x.abs());
                down_m_s2 = down_m_s2.max(followed.acceleration_m_s2.z);
                up_m_s2 = up_m_s2.max(-followed.acceleration_m_s2.z);
            }
        }
        // What was asked for while the vertical motion still took all of the thrust is forgotten.
        assert!(aside_m < 0.01, "{aside_m}");
        assert!((3.9..6.5).contains(&down_m_s2) && (3.9..6.5).contains(&up_m_s2), "{down_m_s2} {up_m_s2}");
    }

    #[test]
    fn what_is_not_far_beyond_is_followed_itself() {
        let configuration = Configuration::default();
        let mut way = NarrowedWay::default();
        let mut narrowed = |rate_rad_s: f64, step: u64| {
            way.follow(
                &configuration,
                AVAILABLE_RAD_S2,
                (&circle(rate_rad_s, step * STEP_US), true),
                step * STEP_US,
            )
            .is_some()
        };
        // 7.7 m/s² of 6
        assert!((0..5_000).all(|step| !narrowed(1.38, step)));
        assert!((5_000..8_000).all(|step| narrowed(2.0, step)));
        // Forgotten by and by.
        assert!(narrowed(1.0, 8_001));
        assert!((8_002..60_000).any(|step| !narrowed(1.0, step)));
        assert!((60_000..61_000).all(|step| !narrowed(1.0, step)));
    }

    /// Along a line the way crosses its reference at speed: it does not end there, but where velocities agree, too.
    #[test]
    fn the_way_ends_without_a_jump() {
        let configuration = Configuration::default();
        let line = |amplitude_m: f64, rate_rad_s: f64, time_us: u64| {
            let circle = circle(rate_rad_s, time_us);
            let along = |vector: Vector3<f64>| Vector3::new(vector.x * amplitude_m / 4.0, 0.0, 0.0);
            PositionReference {
                velocity_m_s: along(circle.velocity_m_s),
                acceleration_m_s2: along(circle.acceleration_m_s2),
                jerk_m_s3: along(circle.jerk_m_s3),
                snap_m_s4: along(circle.snap_m_s4),
                ..PositionReference::goal(along(circle.position_m).into(), 0.0)
            }
        };
        let mut way = NarrowedWay::default();
        let (mut apart_m_s, mut ended) = (f64::INFINITY, false);
        for step in 0..60_000 {
            let time_us = step * STEP_US;
            let reference = if step < 10_000 { line(4.0, 3.0, time_us) } else { line(5.0, 1.2, time_us) };
            match way.follow(&configuration, AVAILABLE_RAD_S2, (&reference, true), time_us) {
                Some(followed) => apart_m_s = (followed.velocity_m_s - reference.velocity_m_s).norm(),
                None if step > 10_000 && !ended => {
                    assert!(apart_m_s < 0.02, "{step}: {apart_m_s} m/s");
                    ended = true;
                }
                None => {}
            }
        }
        assert!(ended);
    }

    /// One point that asks for anything is no way.
    #[test]
    fn a_single_point_is_no_way() {
        let configuration = Configuration::default();
        let mut way = NarrowedWay::default();
        let mut narrowed = |step: u64, snap_m_s4: f64| {
            let reference = PositionReference {
                snap_m_s4: Vector3::new(snap_m_s4, 0.0, 0.0),
                ..circle(1.0, step * STEP_US)
            };
            way.follow(&configuration, AVAILABLE_RAD_S2, (&reference, true), step * STEP_US)
                .map_or(0.0, |followed| (followed.position_m - reference.position_m).norm())
        };
        assert!((0..100).all(|step| narrowed(step, 4.0) == 0.0));
        narrowed(100, 1e300);
        let away_m = (101..3_000).map(|step| narrowed(step, 4.0)).fold(0.0, f64::max);
        assert!(away_m < 0.05, "{away_m} m");
    }

    #[test]
    fn a_goal_at_rest_is_followed_at_once() {
        let configuration = Configuration::default();
        let mut way = NarrowedWay::default();
        assert!(way.follow(&configuration, AVAILABLE_RAD_S2, (&circle(3.0, 0), true), 0).is_some());
        assert_eq!(
            way.follow(
                &configuration,
                AVAILABLE_RAD_S2,
                (&PositionReference::goal([1.0; 3], 0.0), true),
                STEP_US
            ),
            None
        );
        assert_eq!(way, NarrowedWay::default());
    }
}
