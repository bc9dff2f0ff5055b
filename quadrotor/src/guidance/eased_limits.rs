//! Limits that were lowered in flight, and those that the present motion began with.

use serde::{Deserialize, Serialize};

use crate::Limits;

/// The limits that are wanted, and beside them the larger ones under which the present motion began.
///
/// A motion that began under larger limits may be unable to keep smaller ones: an acceleration is taken out with a jerk, a speed
/// is braked with an acceleration, and with less of them the vehicle would leave its way. Until the motion fits the wanted
/// limits, it may use the kept ones. Whoever plans or steers the motion decides when it fits and calls [`EasedLimits::release`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct EasedLimits {
    wanted: Limits,
    kept: Limits,
}

impl EasedLimits {
    /// One set of limits, for a motion that fits it.
    pub fn new(limits: &Limits) -> Self {
        Self { wanted: *limits, kept: *limits }
    }

    /// Changes what is wanted. Larger limits hold at once; smaller ones leave the previous ones kept.
    pub fn want(&mut self, limits: &Limits) {
        if self.wanted != *limits {
            *self = Self { wanted: *limits, kept: self.kept.loosest(limits) };
        }
    }

    /// The limits that are wanted.
    pub fn wanted(&self) -> &Limits {
        &self.wanted
    }

    /// The largest limits since the motion last fitted the wanted ones.
    pub fn kept(&self) -> &Limits {
        &self.kept
    }

    /// Plans within the least of the limits with which there is a plan: the wanted ones, or as little as possible of the
    /// accelerations and jerks of the kept ones. `plan` returns a plan within limits, or none that is good enough. Returns the
    /// plan and whether it is within the wanted limits; `None` if there is none within the kept ones either.
    ///
    /// The speeds are always those that are wanted: braking begins at once, with what the motion has.
    pub fn least<T>(&self, plan: impl Fn(&Limits) -> Option<T>) -> Option<(T, bool)> {
        /// How often the interval between the limits is halved.
        const HALVINGS: usize = 8;
        if let Some(found) = plan(&self.wanted) {
            return Some((found, true));
        }
        let with_share =
            |share: f64| plan(&self.wanted.with_dynamics_of(&self.wanted.towards(&self.kept, share)));
        let (mut best, mut enough, mut too_little) = (with_share(1.0)?, 1.0, 0.0);
        for _ in 0..HALVINGS {
            let share = (too_little + enough) / 2.0;
            match with_share(share) {
                Some(found) => (best, enough) = (found, share),
                None => too_little = share,
            }
        }
        Some((best, false))
    }

    /// The wanted speeds with the accelerations and jerks of the kept limits.
    pub fn largest(&self) -> Limits {
        self.wanted.with_dynamics_of(&self.kept)
    }

    /// Whether the motion may use more than the wanted limits.
    pub fn is_eased(&self) -> bool {
        self.wanted != self.kept
    }

    /// Ends the use of the kept limits: the motion fits the wanted ones.
    pub fn release(&mut self) {
        self.kept = self.wanted;
    }
}

impl Limits {
    /// For each limit the looser one of two.
    pub fn loosest(&self, other: &Self) -> Self {
        self.combined(other, |one, other| if one > other { one } else { other })
    }

    /// Limits between these and larger ones: `share` 0 gives these, 1 the larger ones, in geometric progression.
    fn towards(&self, larger: &Self, share: f64) -> Self {
        self.combined(larger, |from, to| if from > 0.0 { from * libm::pow(to / from, share) } else { to })
    }

    /// Limit by limit. The smallest thrust, where less is looser, is combined by its distance from the weight.
    fn combined(&self, other: &Self, combine: impl Fn(f64, f64) -> f64) -> Self {
        Self {
            tilt_rad: combine(self.tilt_rad, other.tilt_rad),
            tilt_rate_rad_s: combine(self.tilt_rate_rad_s, other.tilt_rate_rad_s),
            tilt_acceleration_rad_s2: combine(self.tilt_acceleration_rad_s2, other.tilt_acceleration_rad_s2),
            thrust_min: if self.thrust_min == other.thrust_min {
                self.thrust_min
            } else {
                1.0 - combine(1.0 - self.thrust_min, 1.0 - other.thrust_min)
            },
            thrust_max: combine(self.thrust_max, other.thrust_max),
            speed_horizontal_m_s: combine(self.speed_horizontal_m_s, other.speed_horizontal_m_s),
            full_speed: self.full_speed,
            speed_up_m_s: combine(self.speed_up_m_s, other.speed_up_m_s),
            speed_down_m_s: combine(self.speed_down_m_s, other.speed_down_m_s),
            acceleration_horizontal_m_s2: combine(
                self.acceleration_horizontal_m_s2,
                other.acceleration_horizontal_m_s2,
            ),
            acceleration_vertical_m_s2: combine(
                self.acceleration_vertical_m_s2,
                other.acceleration_vertical_m_s2,
            ),
            jerk_horizontal_m_s3: combine(self.jerk_horizontal_m_s3, other.jerk_horizontal_m_s3),
            jerk_vertical_m_s3: combine(self.jerk_vertical_m_s3, other.jerk_vertical_m_s3),
            yaw_rate_rad_s: combine(self.yaw_rate_rad_s, other.yaw_rate_rad_s),
            yaw_acceleration_rad_s2: combine(self.yaw_acceleration_rad_s2, other.yaw_acceleration_rad_s2),
            yaw_jerk_rad_s3: combine(self.yaw_jerk_rad_s3, other.yaw_jerk_rad_s3),
        }
    }

    /// The same accelerations and jerks as `other`, and these speeds: braking begins at once, with what the motion has.
    fn with_dynamics_of(&self, other: &Self) -> Self {
        Self {
            speed_horizontal_m_s: self.speed_horizontal_m_s,
            full_speed: self.full_speed,
            speed_up_m_s: self.speed_up_m_s,
            speed_down_m_s: self.speed_down_m_s,
            yaw_rate_rad_s: self.yaw_rate_rad_s,
            ..*other
        }
    }
}

#[cfg(test)]
mod tests {
    use super::EasedLimits;
    use crate::Limits;

    fn with_jerk(jerk_vertical_m_s3: f64) -> Limits {
        Limits { jerk_vertical_m_s3, ..Limits::default() }
    }

    #[test]
    fn the_least_sufficient_limits_are_found() {
        let mut limits = EasedLimits::new(&with_jerk(4.0));
        limits.want(&with_jerk(0.4));
        let least = |needed: f64| {
            limits.least(|limits| (limits.jerk_vertical_m_s3 >= needed).then_some(limits.jerk_vertical_m_s3))
        };
        assert_eq!(least(0.4), Some((0.4, true)));
        assert_eq!(least(4.1), None);
        for needed in [0.41, 1.0, 3.9] {
            let (jerk, as_wanted) = least(needed).unwrap();
            assert!(!as_wanted && jerk >= needed && jerk < 1.02 * needed, "{jerk} for {needed}");
        }
    }

    #[test]
    fn the_largest_limits_are_kept_until_they_are_released() {
        let mut limits = EasedLimits::new(&with_jerk(4.0));
        limits.want(&with_jerk(1.0));
        limits.want(&with_jerk(0.5));
        assert_eq!((limits.wanted(), limits.kept()), (&with_jerk(0.5), &with_jerk(4.0)));
        limits.release();
        assert_eq!(limits, EasedLimits::new(&with_jerk(0.5)));
        limits.want(&with_jerk(2.0));
        assert_eq!(limits, EasedLimits::new(&with_jerk(2.0)), "larger ones hold at once");
    }

    #[test]
    fn the_looser_thrust_limit_is_the_lower_least_thrust() {
        let [narrow, wide] = [(0.9, 1.1), (0.3, 2.0)].map(|(thrust_min, thrust_max)| Limits {
            thrust_min,
            thrust_max,
            ..Limits::default()
        });
        let loosest = narrow.loosest(&wide);
        assert!((loosest.thrust_min - 0.3).abs() < 1e-12 && loosest.thrust_max == 2.0, "{loosest:?}");
    }
}
