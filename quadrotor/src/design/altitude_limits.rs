//! What the altitude controller keeps within.

use lmpc::SignalLimit;
use nalgebra::DMatrix;

use crate::Limits;
use crate::design::limited_samples::in_time;
use crate::design::position_limits::most_speed_m_s;

/// Bounds: acceleration and speed, each down and up.
pub(crate) const ALTITUDE_BOUNDS: usize = 2 * 2;

static THRUST: &[usize] = &[0, 1, 2, 3, 5, 8, 12, 18, 28];
static SPEED: &[usize] = &[1, 2, 4, 6, 8, 10, 13, 16, 20, 26, 34, 50, 80];
/// Violations that cost alike: of the acceleration, m/s², and of the speed, m/s.
const FIRM_M_S2: f64 = 0.5;
const SPEED_M_S: f64 = 4.0;

/// The vertical acceleration, and the speed, with the states of [`altitude_model_with_lag`](crate::altitude_model_with_lag).
pub(crate) fn altitude_limits(sample_time_s: f64) -> [SignalLimit; 2] {
    let range = || DMatrix::from_column_slice(2, 1, &[1.0, -1.0]);
    [
        SignalLimit::of_inputs(3, 1, range(), in_time(THRUST, sample_time_s)).giving_way_by(FIRM_M_S2),
        SignalLimit::of_states(3, 1, &[1], range(), in_time(SPEED, sample_time_s)).giving_way_by(SPEED_M_S),
    ]
}

/// Values of [`altitude_limits`]: G within `range`, and the speeds down and up.
pub(crate) fn altitude_bounds(
    limits: &Limits,
    range: (f64, f64),
    reference_rate_m_s: f64,
) -> [f64; ALTITUDE_BOUNDS] {
    let down = most_speed_m_s(limits.speed_down_m_s, reference_rate_m_s);
    let up = most_speed_m_s(limits.speed_up_m_s, -reference_rate_m_s);
    [range.1, -range.0, down, up]
}

#[cfg(test)]
mod tests {
    use super::{ALTITUDE_BOUNDS, altitude_bounds, altitude_limits};
    use crate::Limits;
    use crate::design::limited_samples::TRANSLATION_SAMPLE_S;

    /// Down is positive: most G and least, then the speeds down and up; a faster reference may be caught up with.
    #[test]
    fn bounds_are_told_in_the_order_of_the_limits() {
        let sides: usize =
            altitude_limits(TRANSLATION_SAMPLE_S).iter().map(|limit| limit.directions.nrows()).sum();
        assert_eq!(sides, ALTITUDE_BOUNDS);
        let limits = Limits { speed_down_m_s: 3.0, speed_up_m_s: 4.0, ..Limits::default() };
        assert_eq!(altitude_bounds(&limits, (-6.0, 2.0), 0.0), [2.0, 6.0, 3.0, 4.0]);
        let [_, _, down, up] = altitude_bounds(&limits, (-6.0, 2.0), -5.0);
        assert!(down == 3.0 && (up - 5.4).abs() < 1e-12, "{down} {up}");
    }
}
