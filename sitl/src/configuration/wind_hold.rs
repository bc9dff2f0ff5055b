//! Whether the vehicle can hold its position in the wind that was asked for.

use quadrotor::{Configuration, side_force_limit_n};
use vehicle::world::WindSettings;
use vehicle::{Notice, Severity};

/// Gusts reach this many standard deviations. Measured over two minutes of gusts of 1 to 3 m/s: with this much room below
/// the limit the vehicle stays within 0.8 m of its place, with half of it metres are lost.
const GUST_DEVIATIONS: f64 = 3.0;

/// A warning, if the wind or its gusts push harder than the vehicle can hold against.
pub(super) fn warning(configuration: &Configuration, wind: &WindSettings) -> Option<Notice> {
    let limit_n = side_force_limit_n(configuration);
    let [north, east, _] = configuration.airframe.hover_drag_n_s_m();
    // Linear drag: force per speed in the direction of the wind, and in the worst one for gusts in a calm.
    let (sine, cosine) = (libm::sin(wind.from_rad), libm::cos(wind.from_rad));
    let drag_n_s_m =
        if wind.speed_m_s > 0.0 { libm::hypot(north * cosine, east * sine) } else { north.max(east) };
    let strongest_m_s = wind.speed_m_s + GUST_DEVIATIONS * wind.gusts_m_s;
    if drag_n_s_m * strongest_m_s <= limit_n {
        return None;
    }
    let limit_m_s = limit_n / drag_n_s_m;
    let remedy = "reduce the wind or the drag, or raise limits.tilt";
    let text = if wind.speed_m_s > limit_m_s {
        format!(
            "a wind of {:.1} m/s pushes with {:.1} N, but the vehicle holds its position only up to {limit_n:.1} N \
             ({limit_m_s:.1} m/s): it will be blown away; {remedy}",
            wind.speed_m_s,
            drag_n_s_m * wind.speed_m_s,
        )
    } else {
        format!(
            "gusts reach {strongest_m_s:.1} m/s (wind of {:.1} m/s and {GUST_DEVIATIONS} standard deviations), but the \
             vehicle holds its position only up to {limit_m_s:.1} m/s: it will be pushed off for seconds; {remedy}",
            wind.speed_m_s,
        )
    };
    Some(Notice { severity: Severity::Warning, text })
}
