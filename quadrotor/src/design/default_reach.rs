//! How far an airframe may lean and how much thrust it may use.

use crate::Limits;
use crate::design::controller_limits::USABLE_THRUST_SHARE;
use crate::plant::airframe::Airframe;

/// Least thrust beside the weight that a default leaves, as a multiple of the weight: the lower end of the range of `limits.thrust.max`.
const LEAST_SPARE: f64 = 0.05;

/// Thrust beside the weight that the altitude controller may use, as a multiple of the weight: that of the default limits, or what the rotors
/// make with a fifth in reserve.
pub(crate) fn default_spare_thrust(airframe: &Airframe) -> f64 {
    let usable = USABLE_THRUST_SHARE / airframe.hover_thrust_share();
    (usable.min(Limits::default().thrust_max) - 1.0).max(LEAST_SPARE)
}

/// Largest tilt, rad: that of the default limits, or where holding the altitude takes half of the spare thrust.
pub(crate) fn default_tilt_rad(airframe: &Airframe) -> f64 {
    let by_thrust = libm::acos(1.0 / (1.0 + default_spare_thrust(airframe) / 2.0));
    Limits::default().tilt_rad.min(by_thrust)
}
