//! What the predictive controllers keep within, as [`Limit`]s and their values at a sample.

use alloc::vec::Vec;
use core::f64::consts::PI;

use lmpc::{Limit, Quantity};
use nalgebra::{DMatrix, Vector2};

use crate::design::capacities::{ALTITUDE_BOUNDS, POSITION_BOUNDS, RATE_SIDES, SPEED_SIDES, TILT_SIDES};
use crate::design::limited_samples::{ALTITUDE, POSITION};
use crate::{Configuration, ControllerSettings, GRAVITY_M_S2, Limits};

/// Share of the rotors' thrust that the altitude controller may use: the rest is for the torques.
pub(crate) const USABLE_THRUST_SHARE: f64 = 0.8;

/// Share of the tilt limit that is commanded. When a raw step saturates the torques the attitude overshoots
/// its command, by half in the worst of many steps tried.
pub(crate) const COMMANDED_TILT_SHARE: f64 = 0.6;

/// By how much the speed of the reference may be exceeded to catch up with it, as a share of the speed limit.
const CATCHING_UP: f64 = 0.1;
/// And by so much at least, m/s: with less room a gust, or the start of a motion, is beyond the bound, and what brings the speed
/// back by full tilt overshoots it on the other side.
const LEAST_CATCHING_UP_M_S: f64 = 0.3;

/// Growth of predicted moves up to which limits are placed on them.
const GROWTH: f64 = 10.0;

/// The samples on which limits of a controller are placed: within its horizon, and before α^m L(m) grows. With
/// α a > 1 the moves that exponential weighting predicts grow without bound, and so would the limits' rows.
pub(crate) fn placed<const P: usize>(settings: &ControllerSettings<P>, samples: &[usize]) -> Vec<usize> {
    let growing = settings.alpha * settings.scale;
    let kept =
        |m: &usize| *m < settings.prediction_horizon as usize && libm::pow(growing, *m as f64) <= GROWTH;
    samples.iter().copied().filter(kept).collect()
}

/// The future samples of states: the first one is a sample later than that of the input.
fn after(samples: &[usize]) -> impl Iterator<Item = usize> {
    samples.iter().map(|m| m + 1)
}

/// Tilt and its increments in all directions alike, and, softly, the horizontal speed.
pub(crate) fn position_limits(settings: &ControllerSettings<2>) -> Vec<Limit> {
    let samples = placed(settings, POSITION);
    let tilt = Limit::polygon(Quantity::Input, TILT_SIDES, samples.iter().copied());
    let increment = Limit::polygon(Quantity::Increment, RATE_SIDES, samples.iter().copied());
    let polygon = Limit::polygon(Quantity::State, SPEED_SIDES, after(&samples));
    // States x, ẋ, y, ẏ.
    let mut directions = DMatrix::zeros(SPEED_SIDES, 4);
    directions.set_column(1, &polygon.directions.column(0));
    directions.set_column(3, &polygon.directions.column(1));
    [tilt, increment, Limit { directions, ..polygon }.soft()].into()
}

fn catching_up_m_s(limit_m_s: f64) -> f64 {
    (CATCHING_UP * limit_m_s).max(LEAST_CATCHING_UP_M_S)
}

/// Values of [`position_limits`]: the largest tilt as |a|/g, its largest increment, and the speed that is
/// left in each direction beside `moving_m_s`.
pub(crate) fn position_bounds(
    limits: &Limits,
    tilt: f64,
    sample_time_s: f64,
    reference_velocity_m_s: &Vector2<f64>,
    moving_m_s: &Vector2<f64>,
) -> [f64; POSITION_BOUNDS] {
    let inside = |sides: usize| libm::cos(PI / sides as f64);
    let increment = limits.tilt_rate_rad_s * sample_time_s;
    let speed = (limits.speed_horizontal_m_s * inside(SPEED_SIDES))
        .max(reference_velocity_m_s.norm() + catching_up_m_s(limits.speed_horizontal_m_s));
    core::array::from_fn(|bound| match bound {
        ..TILT_SIDES => tilt * inside(TILT_SIDES),
        _ if bound < TILT_SIDES + RATE_SIDES => increment * inside(RATE_SIDES),
        _ => {
            let side = bound - TILT_SIDES - RATE_SIDES;
            let angle = 2.0 * PI * side as f64 / SPEED_SIDES as f64;
            let along = Vector2::new(libm::cos(angle), libm::sin(angle)).dot(moving_m_s);
            speed - along
        }
    })
}

/// The vertical acceleration and, softly, the vertical speed.
pub(crate) fn altitude_limits(settings: &ControllerSettings<1>) -> Vec<Limit> {
    let samples = placed(settings, ALTITUDE);
    let acceleration = Limit::range(Quantity::Input, 1, samples.iter().copied());
    // States z, ż.
    let directions = DMatrix::from_row_slice(2, 2, &[0.0, 1.0, 0.0, -1.0]);
    let speed =
        Limit { quantity: Quantity::State, directions, samples: after(&samples).collect(), soft: true };
    [acceleration, speed].into()
}

/// Values of [`altitude_limits`]: G within `range`, and the speeds down and up that are left beside
/// `moving_m_s`.
pub(crate) fn altitude_bounds(
    limits: &Limits,
    range: (f64, f64),
    reference_rate_m_s: f64,
    moving_m_s: f64,
) -> [f64; ALTITUDE_BOUNDS] {
    let down = limits.speed_down_m_s.max(reference_rate_m_s + catching_up_m_s(limits.speed_down_m_s));
    let up = limits.speed_up_m_s.max(catching_up_m_s(limits.speed_up_m_s) - reference_rate_m_s);
    [range.1, -range.0, down - moving_m_s, up + moving_m_s]
}

/// The largest tilt as |a|/g when the thrust axis may lean by `tilt_rad` under the vertical acceleration G.
pub(crate) fn largest_tilt(tilt_rad: f64, vertical_m_s2: f64) -> f64 {
    libm::tan(tilt_rad) * (GRAVITY_M_S2 - vertical_m_s2).max(0.0) / GRAVITY_M_S2
}

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

#[cfg(test)]
mod tests {
    use alloc::vec; // used by dmatrix!
    use core::f64::consts::PI;

    use nalgebra::{Vector2, dmatrix};

    use super::{
        altitude_bounds, altitude_limits, largest_tilt, placed, position_bounds, position_limits,
        thrust_range_n,
    };
    use crate::{Configuration, Controllers, GRAVITY_M_S2, Limits};

    /// Within the horizon, and while the predicted moves grow at most tenfold.
    #[test]
    fn limits_are_placed_where_the_prediction_is_sound() {
        let mut settings = Controllers::default().altitude;
        (settings.alpha, settings.scale, settings.prediction_horizon) = (1.0, 0.8, 6);
        assert_eq!(placed(&settings, &[0, 3, 5, 6, 20]), [0, 3, 5]);
        // 1.25 · 1.6 = 2: 2³ = 8 and 2⁴ = 16
        (settings.alpha, settings.scale, settings.prediction_horizon) = (1.25, 1.6, 100);
        assert_eq!(placed(&settings, &[0, 3, 4, 6]), [0, 3]);
        // 10¹ is ten.
        (settings.alpha, settings.scale) = (10.0, 1.0);
        assert_eq!(placed(&settings, &[0, 1, 2]), [0, 1]);
    }

    /// States are bounded a sample later than inputs, the speed alone and softly.
    #[test]
    fn speeds_are_limited_softly_and_one_sample_later() {
        let controllers = Controllers::default();
        let [tilt, increment, speed]: [_; 3] = position_limits(&controllers.position).try_into().unwrap();
        assert_eq!((tilt.directions.shape(), increment.directions.shape()), ((16, 2), (8, 2)));
        assert_eq!(speed.directions.shape(), (16, 4));
        assert!(speed.soft && !tilt.soft && !increment.soft);
        for (earlier, later) in tilt.samples.iter().zip(&speed.samples) {
            assert_eq!(earlier + 1, *later);
        }
        // The fifth of sixteen directions is east: of x, ẋ, y, ẏ the last one.
        for (state, expected) in [0.0, 0.0, 0.0, 1.0].into_iter().enumerate() {
            assert!((speed.directions[(4, state)] - expected).abs() < 1e-15);
            assert!((speed.directions[(0, state)] - f64::from(state == 1)).abs() < 1e-15);
        }
        let [acceleration, speed]: [_; 2] = altitude_limits(&controllers.altitude).try_into().unwrap();
        assert!(speed.soft && !acceleration.soft);
        assert_eq!(speed.directions, dmatrix![0.0, 1.0; 0.0, -1.0], "of z, ż: down and up");
        assert_eq!((acceleration.samples[0], speed.samples[0]), (0, 1));
        assert_eq!(acceleration.samples.len(), speed.samples.len());
    }

    fn limits() -> Limits {
        Limits {
            tilt_rate_rad_s: 2.0,
            speed_horizontal_m_s: 8.0,
            speed_down_m_s: 2.0,
            speed_up_m_s: 5.0,
            ..Limits::default()
        }
    }

    /// Polygons inside circles: cos(π/n) of the radius.
    #[test]
    fn horizontal_bounds_lie_inside_their_circles() {
        let still = Vector2::zeros();
        let bounds = position_bounds(&limits(), 0.5, 0.05, &still, &still);
        assert!(bounds[..16].iter().all(|bound| (bound - 0.5 * libm::cos(PI / 16.0)).abs() < 1e-15));
        assert!(bounds[16..24].iter().all(|bound| (bound - 2.0 * 0.05 * libm::cos(PI / 8.0)).abs() < 1e-15));
        assert!(bounds[24..].iter().all(|bound| (bound - 8.0 * libm::cos(PI / 16.0)).abs() < 1e-14));
        // Moving north-east at (3, 4) there are 5 less that way, 5 more the other way; 4 less east.
        let moving = position_bounds(&limits(), 0.5, 0.05, &still, &Vector2::new(3.0, 4.0));
        let speed = 8.0 * libm::cos(PI / 16.0);
        for (side, along) in [(0, 3.0), (4, 4.0), (8, -3.0), (12, -4.0), (2, 7.0 / libm::sqrt(2.0))] {
            assert!((moving[24 + side] - (speed - along)).abs() < 1e-13, "side {side}");
        }
        // A reference at the limit may be caught up with: by a tenth of it.
        let fast = position_bounds(&limits(), 0.5, 0.05, &Vector2::new(6.0, -8.0), &still);
        assert!(fast[24..].iter().all(|bound| (bound - 10.8).abs() < 1e-14));
        // Or by 0.3 m/s.
        let slow = Limits { speed_horizontal_m_s: 1.0, ..limits() };
        let slow = position_bounds(&slow, 0.5, 0.05, &Vector2::new(0.0, 1.0), &still);
        assert!(slow[24..].iter().all(|bound| (bound - 1.3).abs() < 1e-14));
    }

    /// Down is positive.
    #[test]
    fn vertical_bounds_leave_room_to_catch_up() {
        let bounds = |rate: f64, moving: f64| altitude_bounds(&limits(), (-4.0, 3.0), rate, moving);
        assert_eq!(bounds(0.0, 0.0), [3.0, 4.0, 2.0, 5.0]);
        assert_eq!(bounds(0.0, 1.5), [3.0, 4.0, 0.5, 6.5]);
        assert_eq!(bounds(2.0, 0.0), [3.0, 4.0, 2.3, 5.0]);
        assert_eq!(bounds(-5.0, 0.0), [3.0, 4.0, 2.0, 5.5]);
    }

    /// m g tan θ of the weight that is left: none in free fall.
    #[test]
    fn the_tilt_is_bounded_by_the_thrust_that_carries() {
        assert!((largest_tilt(0.5, 0.0) - libm::tan(0.5)).abs() < 1e-15);
        assert!((largest_tilt(0.5, -GRAVITY_M_S2) - 2.0 * libm::tan(0.5)).abs() < 1e-15);
        assert_eq!((largest_tilt(0.5, GRAVITY_M_S2), largest_tilt(0.5, 2.0 * GRAVITY_M_S2)), (0.0, 0.0));
    }

    /// In multiples of the weight, 6.864655 N, within what the rotors make: 0.27 N to four fifths of 21.87 N.
    #[test]
    fn the_thrust_is_bounded_by_settings_and_rotors() {
        let range = |thrust_min: f64, thrust_max: f64| {
            let mut configuration = Configuration::default();
            (configuration.limits.thrust_min, configuration.limits.thrust_max) = (thrust_min, thrust_max);
            thrust_range_n(&configuration)
        };
        let near = |range: (f64, f64), least: f64, most: f64| {
            assert!((range.0 - least).abs() < 1e-12 && (range.1 - most).abs() < 1e-12, "{range:?}");
        };
        near(range(0.6, 2.0), 0.6 * 6.864_655, 2.0 * 6.864_655);
        near(range(0.01, 3.0), 0.27, 0.8 * 21.87);
        // A vehicle that is too heavy has one thrust left.
        near(range(2.9, 2.0), 2.9 * 6.864_655, 2.9 * 6.864_655);
    }
}
