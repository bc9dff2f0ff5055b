//! What commands keep within.

use crate::{Configuration, GRAVITY_M_S2};

/// Share of the rotors' thrust that the altitude controller may use: the rest is for the torques.
pub(crate) const USABLE_THRUST_SHARE: f64 = 0.8;

/// Share of the tilt limit that is commanded. When a raw step saturates the torques the attitude overshoots
/// its command, by half in the worst of many steps tried.
pub(crate) const COMMANDED_TILT_SHARE: f64 = 0.94;

/// Thrust, N, that an attitude target keeps whatever its torques need: what holds the altitude at a tilt of the given cosine, as
/// far as the altitude controller may use it.
pub(crate) fn least_thrust_n(configuration: &Configuration, upright: f64) -> f64 {
    let (_, strongest) = configuration.airframe.thrust_range_n();
    (configuration.believed_mass_kg() * GRAVITY_M_S2 / upright).min(USABLE_THRUST_SHARE * strongest)
}

/// Smallest and largest thrust that the altitude controller asks for, N.
pub(crate) fn thrust_range_n(configuration: &Configuration) -> (f64, f64) {
    let limits = &configuration.limits;
    let weight = configuration.airframe.weight_n();
    let (weakest, strongest) = configuration.airframe.thrust_range_n();
    let least = (limits.thrust_min * weight).max(weakest);
    (least, (limits.thrust_max * weight).min(USABLE_THRUST_SHARE * strongest).max(least))
}
