//! The largest horizontal force that a hovering vehicle can hold its place against.

use crate::Configuration;
use crate::design::controller_limits::{COMMANDED_TILT_SHARE, thrust_range_n};

/// Largest tilt that the position controller commands, rad, beside a reference that does not lean farther itself: 0.91 of the tilt
/// limit. The rest is room for the attitude to overshoot its command.
pub fn commanded_tilt_rad(configuration: &Configuration) -> f64 {
    COMMANDED_TILT_SHARE * configuration.limits.tilt_rad
}

/// Largest thrust that the altitude controller commands, N.
pub fn commanded_thrust_n(configuration: &Configuration) -> f64 {
    thrust_range_n(configuration).1
}

/// Largest steady horizontal force, N, that a hovering vehicle can hold its place against.
///
/// A tilt θ whose thrust carries the weight m g pushes sideways with m g tan θ. The tilt goes up to
/// [`commanded_tilt_rad`], and the thrust up to its limit F: m g tan θ ≤ √(F² − (m g)²). All controllers reach it, in every
/// direction.
pub fn side_force_limit_n(configuration: &Configuration) -> f64 {
    let weight_n = configuration.airframe.weight_n();
    let strongest_n = commanded_thrust_n(configuration);
    let by_tilt_n = weight_n * libm::tan(commanded_tilt_rad(configuration));
    let by_thrust_n = libm::sqrt((strongest_n * strongest_n - weight_n * weight_n).max(0.0));
    by_tilt_n.min(by_thrust_n)
}
