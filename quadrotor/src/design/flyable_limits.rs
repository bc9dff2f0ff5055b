//! The limits of a reference that the controllers can follow.

use crate::design::controller_limits::{holding_horizontal_m_s2, thrust_range_n};
use crate::{Configuration, GRAVITY_M_S2, Limits};

/// Share of the thrust beside the weight that a reference uses: the rest is for the feedback, for tilting and against drag.
const THRUST_SHARE: f64 = 0.75;
/// Share of the rate of the tilt command that a reference uses.
const TILT_RATE_SHARE: f64 = 0.75;
/// How long the tilt command may take to change its rate as the jerk of the reference jumps, s.
const TILT_RATE_CHANGE_S: f64 = 0.1;
/// The smallest acceleration, m/s², and jerk, m/s³, that the limits on thrust and tilt leave a reference: the lower ends of the
/// declared ranges.
const LEAST: f64 = 0.1;

impl Configuration {
    /// The limits that references keep: the configured ones, with accelerations and jerks that the limits on thrust and tilt
    /// commands allow. At most as large as the configured ones.
    ///
    /// ```text
    /// vertical acceleration     ¾ of what the thrust limits leave beside the weight, in the weaker direction
    /// horizontal acceleration   ¾ of that beside which the largest thrust holds the altitude
    /// horizontal jerk           ¾ g · tilt rate,  g · tilt acceleration · 0.1 s
    /// ```
    ///
    /// A configuration whose tilt commands cannot make the horizontal acceleration is refused.
    pub fn flyable_limits(&self) -> Limits {
        let weight_n = self.believed_mass_kg() * GRAVITY_M_S2;
        let (least_n, most_n) = thrust_range_n(self);
        let spare_n = (most_n - weight_n).min(weight_n - least_n);
        let vertical = THRUST_SHARE * GRAVITY_M_S2 * spare_n / weight_n;
        let horizontal = THRUST_SHARE * holding_horizontal_m_s2(self, 0.0);
        let limits = &self.limits;
        let jerk = GRAVITY_M_S2
            * (TILT_RATE_SHARE * limits.tilt_rate_rad_s)
                .min(limits.tilt_acceleration_rad_s2 * TILT_RATE_CHANGE_S);
        Limits {
            acceleration_horizontal_m_s2: limits.acceleration_horizontal_m_s2.min(horizontal),
            acceleration_vertical_m_s2: limits.acceleration_vertical_m_s2.min(vertical.max(LEAST)),
            jerk_horizontal_m_s3: limits.jerk_horizontal_m_s3.min(jerk.max(LEAST)),
            ..*limits
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{Configuration, GRAVITY_M_S2};

    /// Beside an acceleration a the altitude takes a thrust of m √(g² + a²); 2 % of it are left to the altitude controller. Drag takes
    /// what the reference leaves.
    #[test]
    fn references_lean_no_farther_than_the_thrust_holds_the_altitude() {
        let mut configuration = Configuration::default();
        let configured = configuration.limits.acceleration_horizontal_m_s2;
        assert_eq!(configuration.flyable_limits().acceleration_horizontal_m_s2, configured);
        configuration.limits.thrust_max = 1.05;
        let flyable = configuration.flyable_limits().acceleration_horizontal_m_s2;
        let thrust = GRAVITY_M_S2.hypot(flyable / 0.75) / (0.995 * GRAVITY_M_S2);
        assert!((thrust - 1.05).abs() < 1e-12, "{flyable}: {thrust}");
    }
}
