//! How a reference goes on whose future nobody has told.

use nalgebra::Vector3;

use crate::PositionReference;

/// So long all of its derivatives count, s. A motion of 1.5 rad/s and 4 m is off by less than 1 mm then.
const KNOWN_S: f64 = 0.3;
/// And within this time, s, its acceleration ends.
const FADING_S: f64 = 0.7;
/// A motion that turns more slowly, rad/s, is not foreseen to turn: within the horizon of a plan it may as well end.
const SLOWEST_RAD_S: f64 = 0.5;
/// One that turns faster is foreseen at this rate, rad/s: nobody flies so.
const FASTEST_RAD_S: f64 = 5.0;

impl PositionReference {
    /// The point `time_s` later under constant snap and constant yaw acceleration.
    pub fn after(&self, time_s: f64) -> Self {
        let t = time_s;
        let (v, a, j, s) = (self.velocity_m_s, self.acceleration_m_s2, self.jerk_m_s3, self.snap_m_s4);
        Self {
            position_m: self.position_m + (v + (a / 2.0 + (j / 6.0 + s * (t / 24.0)) * t) * t) * t,
            velocity_m_s: v + (a + (j / 2.0 + s * (t / 6.0)) * t) * t,
            acceleration_m_s2: a + (j + s * (t / 2.0)) * t,
            jerk_m_s3: j + s * t,
            snap_m_s4: s,
            yaw_rad: self.yaw_rad + (self.yaw_rate_rad_s + self.yaw_acceleration_rad_s2 * (t / 2.0)) * t,
            yaw_rate_rad_s: self.yaw_rate_rad_s + self.yaw_acceleration_rad_s2 * t,
            yaw_acceleration_rad_s2: self.yaw_acceleration_rad_s2,
        }
    }

    /// The point that is expected `time_s` later: for 0.3 s by its derivatives, then its acceleration fades out evenly within
    /// 0.7 s, and after that it goes on with a constant velocity. So an expectation is bounded however long it reaches.
    pub fn expected_after(&self, time_s: f64) -> Self {
        if time_s <= KNOWN_S {
            return self.after(time_s);
        }
        let known = self.after(KNOWN_S);
        let fading = Self {
            jerk_m_s3: known.acceleration_m_s2 / -FADING_S,
            snap_m_s4: Vector3::zeros(),
            yaw_acceleration_rad_s2: 0.0,
            ..known
        };
        let faded_s = time_s - KNOWN_S;
        if faded_s <= FADING_S {
            return fading.after(faded_s);
        }
        let end = fading.after(FADING_S);
        let zero = Vector3::zeros();
        Self { acceleration_m_s2: zero, jerk_m_s3: zero, ..end }.after(faded_s - FADING_S)
    }

    /// The point that a plan counts on `time_s` later. What turns is expected to go on turning: a plan for a way that straightens would
    /// pull against the turns that come. Everything else goes on as [`PositionReference::expected_after`] has it.
    ///
    /// ```text
    /// a(t) = a cos ωt + j/ω sin ωt,  ω² = −(v·j + a·s)/(v·v + a·a)
    /// ```
    ///
    /// is exact on circles, and between the rates of both axes on level figure-eights. What moves up and down turns at a rate of its own. The
    /// terms of a snap that is not known are left out. What brakes on a line is foreseen to swing back. This is the way alone: the heading
    /// of what turns stays that of now.
    pub(crate) fn foreseen_after(&self, time_s: f64) -> Self {
        if time_s <= KNOWN_S {
            return self.after(time_s);
        }
        let (level, upright) = (Vector3::new(1.0, 1.0, 0.0), Vector3::new(0.0, 0.0, 1.0));
        let [level, upright] = [level, upright].map(|axes| self.along(&axes).turned_after(time_s));
        let both = |of: fn(&Self) -> Vector3<f64>| of(&level) + of(&upright);
        Self {
            position_m: both(|way| way.position_m),
            velocity_m_s: both(|way| way.velocity_m_s),
            acceleration_m_s2: both(|way| way.acceleration_m_s2),
            jerk_m_s3: both(|way| way.jerk_m_s3),
            snap_m_s4: both(|way| way.snap_m_s4),
            ..level
        }
    }

    /// Its motion along some axes alone.
    fn along(&self, axes: &Vector3<f64>) -> Self {
        Self {
            position_m: self.position_m.component_mul(axes),
            velocity_m_s: self.velocity_m_s.component_mul(axes),
            acceleration_m_s2: self.acceleration_m_s2.component_mul(axes),
            jerk_m_s3: self.jerk_m_s3.component_mul(axes),
            snap_m_s4: self.snap_m_s4.component_mul(axes),
            ..*self
        }
    }

    /// The same of a motion that turns at one rate, if it turns.
    fn turned_after(&self, time_s: f64) -> Self {
        let Some(turning_1_s2) = self.turning_1_s2() else { return self.expected_after(time_s) };
        let (t, rate) = (time_s, libm::sqrt(turning_1_s2));
        let (sine, cosine) = libm::sincos(rate * t);
        let (v, a, j) = (self.velocity_m_s, self.acceleration_m_s2, self.jerk_m_s3 / turning_1_s2);
        let acceleration = a * cosine + j * (rate * sine);
        Self {
            position_m: self.position_m + (v + j) * t + a * ((1.0 - cosine) / turning_1_s2)
                - j * (sine / rate),
            velocity_m_s: v + a * (sine / rate) + j * (1.0 - cosine),
            acceleration_m_s2: acceleration,
            jerk_m_s3: (j * cosine - a * (sine / rate)) * turning_1_s2,
            snap_m_s4: acceleration * -turning_1_s2,
            ..*self
        }
    }

    /// ω² of a motion that turns.
    fn turning_1_s2(&self) -> Option<f64> {
        let (v, a, j, s) = (self.velocity_m_s, self.acceleration_m_s2, self.jerk_m_s3, self.snap_m_s4);
        let known = if s == Vector3::zeros() { 0.0 } else { 1.0 };
        let size = v.norm_squared() + known * a.norm_squared();
        let turning = -(v.dot(&j) + a.dot(&s));
        (turning > SLOWEST_RAD_S * SLOWEST_RAD_S * size)
            .then(|| (turning / size).min(FASTEST_RAD_S * FASTEST_RAD_S))
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use proptest::prelude::*;

    use super::{FADING_S, KNOWN_S};
    use crate::PositionReference;
    use crate::guidance::known_motion;

    fn reference() -> impl Strategy<Value = PositionReference> {
        (prop::array::uniform15(-5.0..5.0_f64), prop::array::uniform3(-2.0..2.0_f64)).prop_map(
            |(way, yaw)| {
                let vector = |order: usize| Vector3::from_fn(|axis, _| way[3 * order + axis]);
                PositionReference {
                    position_m: vector(0),
                    velocity_m_s: vector(1),
                    acceleration_m_s2: vector(2),
                    jerk_m_s3: vector(3),
                    snap_m_s4: vector(4),
                    yaw_rad: yaw[0],
                    yaw_rate_rad_s: yaw[1],
                    yaw_acceleration_rad_s2: yaw[2],
                }
            },
        )
    }

    proptest! {
        /// Each derivative is that of the one before it, also across the joints, and acceleration and position do not jump there.
        #[test]
        fn an_expectation_is_a_motion(now in reference(), time_s in 0.0..3.0_f64) {
            const H: f64 = 1e-4;
            let at = |time_s: f64| now.expected_after(time_s);
            let [before, here, after] = [at(time_s), at(time_s + H), at(time_s + 2.0 * H)];
            let slope = |of: fn(&PositionReference) -> Vector3<f64>| (of(&after) - of(&before)) / (2.0 * H);
            prop_assert!((slope(|at| at.position_m) - here.velocity_m_s).norm() < 1e-5);
            prop_assert!((slope(|at| at.velocity_m_s) - here.acceleration_m_s2).norm() < 1e-2);
            let joint = [KNOWN_S, KNOWN_S + FADING_S].iter().any(|joint| (time_s + H - joint).abs() <= 2.0 * H);
            prop_assert!(joint || (slope(|at| at.acceleration_m_s2) - here.jerk_m_s3).norm() < 1e-5);
            prop_assert!((after.yaw_rad - before.yaw_rad - 2.0 * H * here.yaw_rate_rad_s).abs() < 1e-6);
            prop_assert!((after.acceleration_m_s2 - before.acceleration_m_s2).norm() < 0.02);
        }

        /// However far it is looked ahead, the velocity is bounded; what rests stays.
        #[test]
        fn an_expectation_is_bounded(now in reference(), time_s in 1.1..1e6_f64) {
            let (end, far) = (now.expected_after(KNOWN_S + FADING_S), now.expected_after(time_s));
            prop_assert!((far.velocity_m_s - end.velocity_m_s).norm() < 1e-9);
            prop_assert_eq!(far.acceleration_m_s2, Vector3::zeros());
            let rest = PositionReference::goal(now.position_m.into(), now.yaw_rad);
            prop_assert_eq!(rest.expected_after(time_s), rest);
        }
    }

    /// A circle of 4 m at 1.5 rad/s.
    fn circle(time_s: f64) -> PositionReference {
        known_motion::circle(4.0, 1.5, time_s)
    }

    /// Also where its snap is not known: the speed tells the rate alone.
    #[test]
    fn a_circle_is_foreseen_as_a_circle() {
        let without_snap = PositionReference { snap_m_s4: Vector3::zeros(), ..circle(1.0) };
        for time_s in [0.31, 1.0, 2.5, 5.5] {
            for now in [circle(1.0), without_snap] {
                let (found, then) = (now.foreseen_after(time_s), circle(1.0 + time_s));
                let derivatives = |at: &PositionReference| {
                    [at.position_m, at.velocity_m_s, at.acceleration_m_s2, at.jerk_m_s3, at.snap_m_s4]
                };
                for (found, then) in derivatives(&found).into_iter().zip(derivatives(&then)) {
                    assert!((found - then).norm() < 1e-9, "{time_s}");
                }
            }
        }
    }

    /// Up and down twice for once there and back, with a different rate of each.
    #[test]
    fn an_upright_figure_eight_is_foreseen_as_one() {
        let eight = |time_s: f64| {
            known_motion::motion(|order| {
                let along = |size_m: f64, rate_rad_s: f64| {
                    let angle = rate_rad_s * time_s + f64::from(order) * core::f64::consts::FRAC_PI_2;
                    size_m * rate_rad_s.powi(order) * libm::sin(angle)
                };
                Vector3::new(along(0.8, 1.5), along(-0.4, 1.5), along(0.3, 3.0))
            })
        };
        for (now_s, time_s) in [(0.1, 0.5), (0.7, 1.0), (2.0, 5.5)] {
            let (found, then) = (eight(now_s).foreseen_after(time_s), eight(now_s + time_s));
            let off_m = (found.position_m - then.position_m).norm();
            let off_m_s2 = (found.acceleration_m_s2 - then.acceleration_m_s2).norm();
            assert!(off_m < 1e-9 && off_m_s2 < 1e-9, "{now_s} + {time_s}: {off_m} m, {off_m_s2} m/s²");
        }
    }

    /// What speeds up or runs straight on does not turn.
    #[test]
    fn a_straight_motion_is_foreseen_as_expected() {
        let straight = PositionReference {
            velocity_m_s: Vector3::new(3.0, 1.0, 0.0),
            acceleration_m_s2: Vector3::new(2.0, -1.0, 0.5),
            ..PositionReference::goal([1.0, 2.0, 3.0], 0.5)
        };
        let faster = PositionReference { jerk_m_s3: Vector3::new(1.0, 0.0, 0.0), ..straight };
        let rest = PositionReference::goal([1.0, 2.0, 3.0], 0.5);
        for now in [straight, faster, rest] {
            for time_s in [0.1, 0.5, 4.0] {
                assert_eq!(now.foreseen_after(time_s), now.expected_after(time_s));
            }
        }
    }

    #[test]
    fn a_circle_is_known_for_a_while() {
        let off = |time_s: f64| {
            (circle(1.0).expected_after(time_s).position_m - circle(1.0 + time_s).position_m).norm()
        };
        assert!(off(KNOWN_S) < 1e-3 && off(2.0 * KNOWN_S) < 0.1, "{} {}", off(KNOWN_S), off(2.0 * KNOWN_S));
    }
}
