//! The largest horizontal force that a hovering vehicle can hold its place against.

use crate::Configuration;
use crate::design::controller_limits::{commanded_tilt_rad, thrust_range_n};

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
