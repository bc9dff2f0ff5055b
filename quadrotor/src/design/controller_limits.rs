//! What commands keep within.

use crate::{Configuration, GRAVITY_M_S2};

/// Share of the rotors' thrust that the altitude controller may use: the rest is for the torques.
pub(crate) const USABLE_THRUST_SHARE: f64 = 0.8;

/// Share of the tilt limit that is commanded. The attitude overshoots its command by up to 9 % in random raw steps that begin with a
/// descent: at its least thrust a vehicle has less torque.
pub(crate) const COMMANDED_TILT_SHARE: f64 = 0.91;
/// Share of the tilt limit up to which a reference may lean itself: a lean that is foretold with its derivatives is not overshot.
const REFERENCE_TILT_SHARE: f64 = 0.96;

/// Largest tilt that the position controller commands, rad, beside a reference that does not lean farther itself: 0.91 of the tilt
/// limit. The rest is room for the attitude to overshoot its command.
pub fn commanded_tilt_rad(configuration: &Configuration) -> f64 {
    COMMANDED_TILT_SHARE * configuration.limits.tilt_rad
}

/// Largest tilt of a reference that is followed as it is, rad.
pub(crate) fn reference_tilt_rad(configuration: &Configuration) -> f64 {
    REFERENCE_TILT_SHARE * configuration.limits.tilt_rad
}

/// Thrust, N, that an attitude target keeps whatever its torques need: what holds the altitude at a tilt of the given cosine, as
/// far as the altitude controller may use it.
pub(crate) fn least_thrust_n(configuration: &Configuration, upright: f64) -> f64 {
    let (_, strongest) = configuration.airframe.thrust_range_n();
    (configuration.believed_mass_kg() * GRAVITY_M_S2 / upright).min(USABLE_THRUST_SHARE * strongest)
}

/// Thrust, as a share of what would hold the altitude, that a lean leaves for more than holding it.
const HOLDING_SHARE: f64 = 0.995;
/// Horizontal acceleration, m/s², that is commanded however weak the rotors are: a lean of 6° costs half a percent of the thrust.
pub(crate) const LEAST_HORIZONTAL_M_S2: f64 = 1.0;

/// The largest horizontal acceleration, m/s², beside which the thrust holds the altitude against an estimated acceleration down that
/// it does not explain, m/s²: |a|² + (g + d)² ≤ (F/m)².
pub(crate) fn holding_horizontal_m_s2(configuration: &Configuration, disturbance_m_s2: f64) -> f64 {
    let (_, most) = thrust_range_n(configuration);
    let strongest = HOLDING_SHARE * most / configuration.believed_mass_kg();
    let weight = GRAVITY_M_S2 + disturbance_m_s2;
    libm::sqrt((strongest * strongest - weight * weight).max(0.0)).max(LEAST_HORIZONTAL_M_S2)
}

/// Smallest and largest thrust that the altitude controller asks for, N.
pub(crate) fn thrust_range_n(configuration: &Configuration) -> (f64, f64) {
    let limits = &configuration.limits;
    let weight = configuration.airframe.weight_n();
    let (weakest, strongest) = configuration.airframe.thrust_range_n();
    let least = (limits.thrust_min * weight).max(weakest);
    (least, (limits.thrust_max * weight).min(USABLE_THRUST_SHARE * strongest).max(least))
}
