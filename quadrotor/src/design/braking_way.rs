//! What is left of the way to a goal at rest, as a limit of the speed towards it.

use lmpc::SignalLimit;
use nalgebra::{DMatrix, Vector2};

use crate::Limits;
use crate::design::limited_samples::in_time;
use crate::design::position_limits::{AXIS_STATES, POSITION_BOUNDS, POSITION_STATES, UNBOUNDED};

/// One over the times, 1/s, that braking takes where each tangent touches: shorter braking is within sight of a plan.
const SLOPES_1_S: [f64; 3] = [0.5, 0.25, 0.125];
/// Along both axes, one of which is that of the error.
const DIRECTIONS: usize = 4;
/// Bounds, one per direction of each limit.
const BRAKING_BOUNDS: usize = SLOPES_1_S.len() * DIRECTIONS;
/// Samples at which the rest of the way must be long enough.
static SAMPLES: &[usize] = &[7, 14, 24, 40];
/// A violation that costs as much as those of the other limits, m/s.
const FIRM_M_S: f64 = 8.0;

/// Share of the largest acceleration that braking is planned with: feedback has the rest.
const PLANNED: f64 = 0.9;
/// The least of it that is counted on against what pushes.
const LEAST: f64 = 0.1;

/// Limited signals of [`braking_limits`] at most: two horizontal ones for each slope and sample.
pub(crate) const BRAKING_SIGNALS: usize = 2 * SLOPES_1_S.len() * SAMPLES.len();

/// v + c x along both axes, one limit for each slope c, with the states of
/// [`PositionDesign`](crate::design::translation_design::PositionDesign).
pub(crate) fn braking_limits(sample_time_s: f64) -> [SignalLimit; SLOPES_1_S.len()] {
    SLOPES_1_S.map(|slope_1_s| SignalLimit {
        state: DMatrix::from_fn(2, POSITION_STATES, |axis, state| {
            match state.checked_sub(axis * AXIS_STATES) {
                Some(0) => slope_1_s,
                Some(1) => 1.0,
                _ => 0.0,
            }
        }),
        input: DMatrix::zeros(2, 2),
        directions: SignalLimit::polygon(DIRECTIONS),
        samples: in_time(SAMPLES, sample_time_s),
        relaxation: FIRM_M_S,
    })
}

/// How long the tilt takes from one lean to the opposite one, from rest to rest, s.
pub(crate) fn swing_s(limits: &Limits) -> f64 {
    let (way_rad, rate, acceleration) =
        (2.0 * limits.tilt_rad, limits.tilt_rate_rad_s, limits.tilt_acceleration_rad_s2);
    let reaches_rate = way_rad * acceleration > rate * rate;
    if reaches_rate { way_rad / rate + rate / acceleration } else { 2.0 * libm::sqrt(way_rad / acceleration) }
}

/// The way to a goal at rest, and what there is to brake with.
///
/// A vehicle that brakes with a from a speed v, and begins with it after a time τ, comes to rest within
///
/// ```text
/// d = v²/(2a) + τ v
/// ```
///
/// The speeds that are slow enough at a distance d are a convex set. A plan keeps to some of its tangents, that with the slope c touching
/// where braking takes 1/c − τ:
///
/// ```text
/// v ≤ c d + (1 − c τ)² a/(2c)
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BrakingWay {
    /// Position of the goal in the terms of the state that is limited, m.
    pub(crate) goal_m: Vector2<f64>,
    /// Position minus goal, m.
    pub(crate) error_m: Vector2<f64>,
    /// The largest horizontal acceleration by the thrust, m/s².
    pub(crate) thrust_m_s2: f64,
    /// What else accelerates, m/s².
    pub(crate) disturbance_m_s2: Vector2<f64>,
    /// τ, s.
    pub(crate) delay_s: f64,
}

impl BrakingWay {
    /// τ under some limits: during the half of a swing that leads to the largest lean, half of its acceleration is missing.
    pub(crate) fn delay_s(limits: &Limits) -> f64 {
        swing_s(limits) / 4.0
    }

    /// Values of the limits of the position, and behind them those of [`braking_limits`].
    pub(crate) fn bounds_behind(
        of_position: &[f64; POSITION_BOUNDS],
        way: Option<&Self>,
    ) -> [f64; POSITION_BOUNDS + BRAKING_BOUNDS] {
        let braking = Self::bounds(way);
        core::array::from_fn(|bound| match bound.checked_sub(POSITION_BOUNDS) {
            None => of_position[bound],
            Some(behind) => braking[behind],
        })
    }

    /// Values of [`braking_limits`]; without a way, for no goal at rest, nothing is limited.
    fn bounds(way: Option<&Self>) -> [f64; BRAKING_BOUNDS] {
        core::array::from_fn(|bound| {
            way.map_or(UNBOUNDED, |way| way.bound(SLOPES_1_S[bound / DIRECTIONS], bound % DIRECTIONS))
        })
    }

    /// That of v + c x in a direction. Only those towards the goal have one.
    fn bound(&self, slope_1_s: f64, direction: usize) -> f64 {
        let towards = [Vector2::x(), Vector2::y(), -Vector2::x(), -Vector2::y()][direction];
        let share = 1.0 - slope_1_s * self.delay_s;
        if towards.dot(&self.error_m) >= 0.0 || share < 0.0 {
            return UNBOUNDED;
        }
        let held_m_s2 = self.thrust_m_s2 * PLANNED - towards.dot(&self.disturbance_m_s2);
        let braking_m_s2 = held_m_s2.max(self.thrust_m_s2 * LEAST);
        slope_1_s * towards.dot(&self.goal_m) + share * share * braking_m_s2 / (2.0 * slope_1_s)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DVector, Vector2};

    use super::{BRAKING_BOUNDS, BrakingWay, braking_limits, swing_s};
    use crate::Limits;
    use crate::design::limited_samples::TRANSLATION_SAMPLE_S;
    use crate::design::position_limits::UNBOUNDED;
    use crate::design::position_limits::{AXIS_STATES, POSITION_STATES};

    fn way(delay_s: f64) -> BrakingWay {
        BrakingWay {
            goal_m: Vector2::new(30.0, -4.0),
            error_m: Vector2::new(-20.0, 0.0),
            thrust_m_s2: 2.0,
            disturbance_m_s2: Vector2::zeros(),
            delay_s,
        }
    }

    /// Whether the limits allow a speed north, m/s, at a distance south of the goal, m.
    fn allowed(way: &BrakingWay, speed_m_s: f64, distance_m: f64) -> bool {
        let mut state = DVector::zeros(POSITION_STATES);
        (state[0], state[1]) = (way.goal_m.x - distance_m, speed_m_s);
        state[AXIS_STATES] = way.goal_m.y;
        let bounds = BrakingWay::bounds(Some(way));
        let mut bounds = bounds.iter();
        braking_limits(TRANSLATION_SAMPLE_S).iter().all(|limit| {
            let signals = &limit.directions * (&limit.state * &state);
            signals.iter().all(|signal| signal <= bounds.next().unwrap())
        })
    }

    /// Whoever brakes with 0.9 · 2 m/s² after the delay comes to rest before the goal, by Torricelli: such speeds are allowed, and hardly
    /// any that are faster, as long as braking takes from 1.4 to 8 s.
    #[test]
    fn what_can_be_braked_is_allowed() {
        for delay_s in [0.0, 0.4] {
            for tenths in 14..80 {
                let speed_m_s = 1.8 * f64::from(tenths) / 10.0;
                let distance_m = speed_m_s * speed_m_s / (2.0 * 1.8) + delay_s * speed_m_s;
                assert!(allowed(&way(delay_s), speed_m_s, distance_m + 1e-9), "{speed_m_s} m/s");
                assert!(
                    !allowed(&way(delay_s), 1.07 * speed_m_s, distance_m),
                    "{speed_m_s} m/s, {delay_s} s"
                );
            }
        }
    }

    /// Away from the goal and across nothing is limited, nor is anything without a goal.
    #[test]
    fn only_the_way_to_the_goal_is_limited() {
        assert!(BrakingWay::bounds(None).iter().all(|bound| *bound == UNBOUNDED));
        let bounds = BrakingWay::bounds(Some(&way(0.0)));
        let limited = (0..BRAKING_BOUNDS).filter(|at| bounds[*at] < UNBOUNDED);
        assert!(limited.eq([0, 4, 8]));
    }

    /// A wind from behind leaves less to brake with, and one from ahead more.
    #[test]
    fn wind_counts() {
        let pushed = |by_m_s2: f64| BrakingWay { disturbance_m_s2: Vector2::new(by_m_s2, 0.3), ..way(0.0) };
        let calm = BrakingWay::bounds(Some(&way(0.0)))[0];
        assert!((BrakingWay::bounds(Some(&pushed(0.9)))[0] - (calm - 0.9)).abs() < 1e-12);
        assert!((BrakingWay::bounds(Some(&pushed(-0.9)))[0] - (calm + 0.9)).abs() < 1e-12);
        // A tenth of the thrust at least.
        assert!((BrakingWay::bounds(Some(&pushed(9.0)))[0] - (calm - 1.6)).abs() < 1e-12);
    }

    /// 1.2 rad at 2 rad/s, of which a quarter of a second each is lost at both ends, or without reaching that rate.
    #[test]
    fn a_swing_takes_as_long_as_rate_and_acceleration_demand() {
        let limits = Limits { tilt_rad: 0.6, tilt_rate_rad_s: 2.0, ..Limits::default() };
        for (tilt_acceleration_rad_s2, expected_s) in [(8.0, 0.6 + 0.25), (1.0, 2.0 * libm::sqrt(1.2))] {
            let found_s = swing_s(&Limits { tilt_acceleration_rad_s2, ..limits });
            assert!((found_s - expected_s).abs() < 1e-12, "{found_s}");
        }
    }
}
