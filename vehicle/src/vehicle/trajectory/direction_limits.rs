//! The limits of a motion in one direction.

use libm::sqrt;
use nalgebra::Vector3;
use quadrotor::{AxisLimits, Limits};

/// Limits of speed, m/s, acceleration, m/s², and jerk, m/s³, along a unit vector, NED: horizontally and vertically each keeps its
/// own.
pub fn limits_along(direction: &Vector3<f64>, limits: &Limits) -> AxisLimits {
    let horizontal = direction.xy().norm();
    let vertical = direction.z.abs();
    let within = |across: f64, down: f64| {
        let by = |share: f64, limit: f64| if share > 1e-9 { limit / share } else { f64::INFINITY };
        by(horizontal, across).min(by(vertical, down))
    };
    let climb = if direction.z < 0.0 { limits.speed_up_m_s } else { limits.speed_down_m_s };
    AxisLimits {
        speed: within(limits.speed_horizontal_m_s, climb),
        acceleration: within(limits.acceleration_horizontal_m_s2, limits.acceleration_vertical_m_s2),
        jerk: within(limits.jerk_horizontal_m_s3, limits.jerk_vertical_m_s3),
    }
}

/// Shortest time in which a velocity changes by so much, m/s, without acceleration before and after it, and how long the
/// acceleration takes to build up, s:
///
/// ```text
/// T(Δv) = Δv/a + a/j,  or 2 √(Δv/j) if the acceleration a is not reached
/// ```
pub fn change_time_s(change_m_s: f64, limits: &AxisLimits) -> (f64, f64) {
    let AxisLimits { acceleration: a, jerk: j, .. } = *limits;
    if change_m_s >= a * a / j {
        (change_m_s / a + a / j, a / j)
    } else {
        let ramp_s = sqrt(change_m_s / j);
        (2.0 * ramp_s, ramp_s)
    }
}

/// Shortest way on which a speed, m/s, changes to another, m.
pub fn change_distance_m(from_m_s: f64, to_m_s: f64, limits: &AxisLimits) -> f64 {
    (from_m_s + to_m_s) / 2.0 * change_time_s((to_m_s - from_m_s).abs(), limits).0
}
