//! How a reference goes on whose future nobody has told.

use nalgebra::Vector3;

use crate::PositionReference;

/// So long all of its derivatives count, s. A motion of 1.5 rad/s and 4 m is off by less than 1 mm then.
const KNOWN_S: f64 = 0.3;
/// And within this time, s, its acceleration ends.
const FADING_S: f64 = 0.7;

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
}
