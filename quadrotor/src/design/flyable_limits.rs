//! The limits of a reference that the controllers can follow.

use crate::design::controller_limits::thrust_range_n;
use crate::{Configuration, GRAVITY_M_S2, Limits};

/// Share of the thrust beside the weight that a reference uses: the rest is for the feedback, and for tilting.
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
    /// vertical acceleration   ¾ of what the thrust limits leave beside the weight, in the weaker direction
    /// horizontal jerk         ¾ g · tilt rate,  g · tilt acceleration · 0.1 s
    /// ```
    ///
    /// The horizontal acceleration needs no such bound: a configuration whose tilt commands cannot make it is refused.
    pub fn flyable_limits(&self) -> Limits {
        let weight_n = self.believed_mass_kg() * GRAVITY_M_S2;
        let (least_n, most_n) = thrust_range_n(self);
        let spare_n = (most_n - weight_n).min(weight_n - least_n);
        let vertical = THRUST_SHARE * GRAVITY_M_S2 * spare_n / weight_n;
        let limits = &self.limits;
        let jerk = GRAVITY_M_S2
            * (TILT_RATE_SHARE * limits.tilt_rate_rad_s)
                .min(limits.tilt_acceleration_rad_s2 * TILT_RATE_CHANGE_S);
        Limits {
            acceleration_vertical_m_s2: limits.acceleration_vertical_m_s2.min(vertical.max(LEAST)),
            jerk_horizontal_m_s3: limits.jerk_horizontal_m_s3.min(jerk.max(LEAST)),
            ..*limits
        }
    }
}
