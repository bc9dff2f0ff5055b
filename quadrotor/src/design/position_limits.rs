//! What the position controller keeps within.

use alloc::vec::Vec;

use lmpc::SignalLimit;
use nalgebra::Vector2;

use crate::control::demand::FOLLOWED;
use crate::design::braking_way::BRAKING_SIGNALS;
use crate::design::limited_samples::{in_time, one_in_time};
use crate::{ControllerKind, GRAVITY_M_S2, Limits};

/// Sides of the polygons about circles of tilt and speed: their corners lie 0.86 % outside.
const SIDES: usize = 24;
/// Sides of the polygons for the rate and the acceleration of the tilt, which need not be finer: 8 %.
const COARSE_SIDES: usize = 8;
/// Bounds, one per side.
pub(crate) const POSITION_BOUNDS: usize = 3 * SIDES + 4 * COARSE_SIDES;

/// Limited signals of [`position_limits`] at most: two horizontal ones of each limit at each of its samples.
const LIMITED_SIGNALS: usize =
    2 * (PRESENT_TILT.len() + TILT.len() + TURNING.len() + LEANING.len() + 2 + MOVING.len());
/// Those of the position controller: of these limits and of the way to brake on.
pub(crate) const POSITION_SIGNALS: usize = LIMITED_SIGNALS + BRAKING_SIGNALS;

/// Samples of the tilt command for which the present thrust counts.
static PRESENT_TILT: &[usize] = &[0, 1, 2, 3, 4];
/// The later ones: those at which it can be chosen, and some of those at which it settles.
static TILT: &[usize] = &[6, 8, 12, 18, 28];
/// Samples of the speed, which follows later, as far as they come after the first two: see [`first_moving`].
static MOVING: &[usize] = &[10, 13, 16, 20, 26, 34, 50, 80];
/// The earliest first one.
const FIRST_MOVING: usize = 4;
/// From the first of them to the second, and the earliest second one.
const MOVING_ON: usize = 2;
const SECOND_MOVING: usize = 7;
/// A speed is limited from when the attitude loop has answered for this long, s, and the next tenth of a second.
const ANSWERED_S: f64 = 0.07;
const TENTH_S: f64 = 0.1;
/// Samples of the rate of the tilt: while commands change fast.
static LEANING: &[usize] = &[1, 2, 3, 5, 8, 13, 20];
/// Samples of its acceleration, which follows a command within one of them. Without the fourth, plans exceed the limit there, and when it
/// has come to be the third, all limits must give way.
static TURNING: &[usize] = &[1, 2, 3, 4, 5, 8, 13, 20];

/// Share of the speed limit that is planned with. A plan is free until the first sample at which its speed is limited, and gains a little
/// each time.
const PLANNED_SPEED: f64 = 0.995;
/// The terms of [`planned_horizon_m`] per speed, s and rad.
const SETTLING_S: f64 = 0.8;
const BEHIND_RAD: f64 = 1.25;
/// By how much the speed of a reference at the speed limit may be exceeded to catch up with it, as a share of the limit.
const CATCHING_UP: f64 = 0.01;
/// The least of it, m/s.
const LEAST_CATCHING_UP_M_S: f64 = 0.05;
/// The same of a reference that is faster than the limit, which is another's plan.
const CATCHING_UP_WITH_FASTER: f64 = 0.1;
/// The same of a way that limits bend: the vehicle is behind it, or is led back by it to a reference that it has lost. A plan that had to keep
/// to its speed would give way at all limits, and swing about the way for ever.
const CATCHING_UP_WITH_BENT: f64 = 0.2;
/// How much more jerk and snap than a reference asks for the feedback may use, as a share of their limits. A reference that turns near them
/// does so all the way round: a plan of a few functions of time, kept to them at each sample, would never come back to its way.
const TURNING_BACK: f64 = 0.5;
/// How much more jerk than its limit is planned with before the attitude loop has answered, as a share of it: see [`first_answered`].
const BEFORE_AN_ANSWER: f64 = 0.1;
/// So many times the limits of tilt rate and tilt acceleration are far beyond them.
const FAR: f64 = 3.0;
/// What rounding makes of a reference at the speed limit.
const ROUNDING: f64 = 1.0 + 1e-6;
/// With how much snap per jerk the attitude loop answers at most when the jerk of the reference jumps, 1/s.
const ANSWER_1_S: f64 = 50.0;
/// A bound that no plan meets.
pub(crate) const UNBOUNDED: f64 = 1e9;
/// Violations that cost alike: the commanded acceleration, m/s², the angular acceleration, rad/s², and the rate of the tilt, rad/s, and the
/// speed, m/s. The tilt is the one to keep.
const FIRM_M_S2: f64 = 0.5;
const TURNING_RAD_S2: f64 = 8.0;
const LEANING_RAD_S: f64 = 2.0;
const SPEED_M_S: f64 = 8.0;

/// States of one axis: position, its derivatives up to the snap that the rotors make, and the snap that they are asked for.
pub(crate) const AXIS_STATES: usize = 6;
/// States of both.
pub(crate) const POSITION_STATES: usize = 2 * AXIS_STATES;

/// The commanded acceleration, and the speed, jerk and snap that follow from it, in all directions alike. They stand for tilt, its
/// rate and its angular acceleration. The speed is limited from a sample on; jerk and snap before the attitude loop has answered have
/// limits of their own.
pub(crate) fn position_limits(
    sample_time_s: f64,
    (first_answered, first_moving): (usize, usize),
) -> [SignalLimit; 7] {
    let of_states = |derivative: usize, sides: usize, samples: Vec<usize>| {
        let limited = [derivative, AXIS_STATES + derivative];
        SignalLimit::of_states(POSITION_STATES, 2, &limited, SignalLimit::polygon(sides), samples)
    };
    let answered = |samples: &[usize]| -> (Vec<usize>, Vec<usize>) {
        in_time(samples, sample_time_s).into_iter().partition(|sample| *sample < first_answered)
    };
    let (turning_before, turning) = answered(TURNING);
    let (leaning_before, leaning) = answered(LEANING);
    let of_inputs = |samples: &[usize]| {
        let samples = in_time(samples, sample_time_s);
        SignalLimit::of_inputs(POSITION_STATES, 2, SignalLimit::polygon(SIDES), samples)
            .giving_way_by(FIRM_M_S2)
    };
    [
        of_inputs(PRESENT_TILT),
        of_inputs(TILT),
        of_states(4, COARSE_SIDES, turning_before).giving_way_by(GRAVITY_M_S2 * TURNING_RAD_S2),
        of_states(4, COARSE_SIDES, turning).giving_way_by(GRAVITY_M_S2 * TURNING_RAD_S2),
        of_states(3, COARSE_SIDES, leaning_before).giving_way_by(GRAVITY_M_S2 * LEANING_RAD_S),
        of_states(3, COARSE_SIDES, leaning).giving_way_by(GRAVITY_M_S2 * LEANING_RAD_S),
        of_states(1, SIDES, moving(first_moving, sample_time_s)).giving_way_by(SPEED_M_S),
    ]
}

/// The first sample at which an attitude loop that lags behind by so much, s, has answered to a command of now.
///
/// Jerk and snap before that are hardly what a plan decides: one of a few functions of time that had to keep their limits there would be a
/// feedback with a gain of many times its own. Beside a reference that nobody foresees it would answer a turn by its opposite.
pub(crate) fn first_answered(attitude_delay_s: f64, sample_time_s: f64) -> usize {
    libm::round(attitude_delay_s / sample_time_s) as usize
}

/// The first sample at which a plan of a controller limits its speed, over an attitude loop that lags behind by so much, s.
///
/// A plan of a few functions of time that had to correct its speed before the attitude loop can would be a feedback with a gain of many times
/// its own: with another mass than it believes in, or rotors that slow down more slowly, it swings. One that was limited later still would
/// first speed up, and cruise above the limit. A plan of free moves has no such gain.
pub(crate) fn first_moving(kind: ControllerKind, attitude_delay_s: f64, sample_time_s: f64) -> usize {
    let earliest = one_in_time(FIRST_MOVING, sample_time_s);
    if kind == ControllerKind::StateSpaceMpc {
        return earliest;
    }
    let tenths = libm::ceil((ANSWERED_S + attitude_delay_s) / TENTH_S);
    // Tenths are whole numbers of most samples, but for rounding.
    let samples = libm::ceil(tenths * TENTH_S / sample_time_s - 1e-6);
    (samples as usize).max(earliest)
}

/// Samples of the speed from the first one on.
fn moving(first: usize, sample_time_s: f64) -> Vec<usize> {
    let one = |sample: usize| one_in_time(sample, sample_time_s);
    let second = (first + one(MOVING_ON)).max(one(SECOND_MOVING));
    let later = in_time(MOVING, sample_time_s).into_iter().filter(|sample| *sample > second);
    [first, second].into_iter().chain(later).collect()
}

/// How the tilt is accelerated whatever is commanded now. A plan that would have to prevent it could only fail, give way at all of its
/// limits, and have no eyes for the way.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub(crate) struct TurnUnderWay {
    /// Snap that the body has, or that its rotors are asked for, m/s⁴. It lasts for the time that the attitude loop takes.
    pub(crate) snap_m_s4: f64,
    /// By how much the jerk of the reference has jumped since the last sample, m/s³: it will be answered.
    pub(crate) jump_m_s3: f64,
    /// Jerk that the body has, and what it takes to bring back a body that was thrown, m/s³.
    pub(crate) jerk_m_s3: f64,
}

/// The most that a reference asks for while it is planned for. What is more than a limit is another's plan, which may be followed: a limit
/// that its own motion breaks would take the feedback the room to follow it.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub(crate) struct Asked {
    /// Acceleration by the thrust, m/s².
    pub(crate) thrust_m_s2: f64,
    /// Speed, m/s.
    pub(crate) speed_m_s: f64,
    /// Jerk, m/s³.
    pub(crate) jerk_m_s3: f64,
    /// Snap, m/s⁴.
    pub(crate) snap_m_s4: f64,
    /// Whether nobody has told how it goes on, and it is followed whole: what is foreseen of it is no plan that keeps limits.
    pub(crate) is_streamed: bool,
    /// Whether limits bend it.
    pub(crate) is_bent: bool,
    /// Whether they do although much of it is left out.
    pub(crate) is_narrow: bool,
}

/// Values of [`position_limits`], the commanded acceleration being at most `present_m_s2` now and `lasting_m_s2` later on, under what the
/// reference asks for: see [`most_speed_m_s`] and [`with_room`].
pub(crate) fn position_bounds(
    limits: &Limits,
    (present_m_s2, lasting_m_s2): (f64, f64),
    asked: &Asked,
    under_way: TurnUnderWay,
) -> [f64; POSITION_BOUNDS] {
    // So much of a narrowed way is followed: less would leave feedback none of it.
    let share = if asked.is_narrow { FOLLOWED } else { 1.0 };
    let [most_m_s3, most_m_s4] =
        [limits.tilt_rate_rad_s, limits.tilt_acceleration_rad_s2].map(|limit| share * GRAVITY_M_S2 * limit);
    let (jerk_m_s3, snap_m_s4) = (asked.jerk_m_s3, asked.snap_m_s4);
    // Of the torque to turn with, weak rotors have none to spare beside a large lean.
    let leaning =
        if asked.is_bent { with_room(most_m_s3, jerk_m_s3) } else { with_faster(most_m_s3, jerk_m_s3) };
    let leaning = leaning.max(under_way.jerk_m_s3);
    let turning =
        with_faster(most_m_s4, snap_m_s4).max(under_way.snap_m_s4) + ANSWER_1_S * under_way.jump_m_s3;
    // One far beyond the limits is not followed for long: see `NarrowedWay`.
    let is_far = jerk_m_s3 > FAR * most_m_s3 || snap_m_s4 > FAR * most_m_s4;
    let [leaning_before, turning_before] = if asked.is_bent || (asked.is_streamed && is_far) {
        [leaning, turning]
    } else if asked.is_streamed {
        [UNBOUNDED; 2]
    } else {
        [(1.0 + BEFORE_AN_ANSWER) * leaning, turning]
    };
    let limit_m_s = limits.speed_horizontal_m_s;
    let speed = if asked.is_bent {
        limit_m_s.max(asked.speed_m_s + by_share_m_s(CATCHING_UP_WITH_BENT, limit_m_s))
    } else {
        most_speed_m_s(limit_m_s, asked.speed_m_s)
    };
    core::array::from_fn(|bound| match bound {
        ..SIDES => present_m_s2,
        _ if bound < 2 * SIDES => lasting_m_s2,
        _ if bound < 2 * SIDES + COARSE_SIDES => turning_before,
        _ if bound < 2 * SIDES + 2 * COARSE_SIDES => turning,
        _ if bound < 2 * SIDES + 3 * COARSE_SIDES => leaning_before,
        _ if bound < 2 * SIDES + 4 * COARSE_SIDES => leaning,
        _ => PLANNED_SPEED * speed,
    })
}

/// The largest distance, m, at which a set-point is seen: a plan that is shorter cannot tell further ones apart, and beyond that the
/// speed limit decides.
///
/// ```text
/// v²/a + 1.2 s · v
/// ```
///
/// The first term is twice the way to brake from the speed limit v at an acceleration a.
pub(crate) fn horizon_m(speed_m_s: f64, acceleration_m_s2: f64) -> f64 {
    speed_m_s * speed_m_s / acceleration_m_s2 + 1.2 * speed_m_s
}

/// The same of a plan of the position, whose way to brake on is a limit of its own: from further away it has no solution that keeps all
/// limits.
///
/// ```text
/// v²/(5a) + v (0.8 s + 1.25/ω)      of a few functions of time
/// v²/(2a) + 1.3 s · v               of free moves
/// ```
///
/// The second term of the former is about the error that a feedback with a bandwidth ω closes at the speed v. It is hardly further, so
/// that little of what such a plan does at the speed limit is held back by that.
pub(crate) fn planned_horizon_m(
    kind: ControllerKind,
    speed_m_s: f64,
    acceleration_m_s2: f64,
    bandwidth_rad_s: f64,
) -> f64 {
    let braking_m = speed_m_s * speed_m_s / acceleration_m_s2;
    match kind {
        ControllerKind::StateSpaceMpc => braking_m / 2.0 + 1.3 * speed_m_s,
        ControllerKind::Lmpc | ControllerKind::Dlqr => {
            braking_m / 5.0 + speed_m_s * (SETTLING_S + BEHIND_RAD / bandwidth_rad_s)
        }
    }
}

/// The largest speed, m/s, while a reference asks for speeds up to `asked_m_s`: the limit, and what it takes to catch up with it.
pub(crate) fn most_speed_m_s(limit_m_s: f64, asked_m_s: f64) -> f64 {
    limit_m_s.max(asked_m_s + catching_up_m_s(limit_m_s, asked_m_s))
}

/// A limit, or as much more than a reference asks for as feedback needs beside it.
fn with_room(limit: f64, asked: f64) -> f64 {
    limit.max(asked + TURNING_BACK * limit)
}

/// A limit, or a little more than a reference that asks for more than it.
fn with_faster(limit: f64, asked: f64) -> f64 {
    if asked > ROUNDING * limit { asked + CATCHING_UP_WITH_FASTER * limit } else { limit }
}

fn catching_up_m_s(limit_m_s: f64, asked_m_s: f64) -> f64 {
    let share = if asked_m_s > ROUNDING * limit_m_s { CATCHING_UP_WITH_FASTER } else { CATCHING_UP };
    by_share_m_s(share, limit_m_s)
}

/// A share of a speed limit to catch up by, m/s.
fn by_share_m_s(share: f64, limit_m_s: f64) -> f64 {
    (share * limit_m_s).max(LEAST_CATCHING_UP_M_S)
}

/// Share of the speed limit with which an error may be closed while the reference moves that way itself, at `ahead_m_s`: what it leaves of
/// the limit, and at least what there is to catch up.
///
/// A plan ends on its reference. One that may not go faster than a reference at the speed limit would put off catching up until after
/// the samples on which it is limited, and fall behind before.
pub(crate) fn closing_share(limit_m_s: f64, ahead_m_s: f64) -> f64 {
    let least = (catching_up_m_s(limit_m_s, ahead_m_s) / limit_m_s).min(1.0);
    (1.0 - ahead_m_s / limit_m_s).clamp(least, 1.0)
}

/// The error that is planned with: of a far one as much as the horizon.
pub(crate) fn in_sight(error: &Vector2<f64>, horizon_m: f64) -> Vector2<f64> {
    // The square of a finite number can be infinite.
    let unit = error.amax().max(1.0);
    let (size, horizon) = ((error / unit).norm(), horizon_m / unit);
    error * (horizon / size.max(horizon))
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector2;

    use super::{
        Asked, COARSE_SIDES, POSITION_BOUNDS, SIDES, TurnUnderWay, UNBOUNDED, first_answered, first_moving,
        horizon_m, in_sight, moving, planned_horizon_m, position_bounds, position_limits,
    };
    use crate::design::limited_samples::TRANSLATION_SAMPLE_S;
    use crate::{ControllerKind, GRAVITY_M_S2, Limits};

    /// Where the bounds of snap and jerk begin, from when the attitude loop has answered on.
    const TURNING_AT: usize = 2 * SIDES + COARSE_SIDES;
    const LEANING_AT: usize = 2 * SIDES + 3 * COARSE_SIDES;

    #[test]
    fn each_side_has_its_bound() {
        let sides: usize =
            position_limits(TRANSLATION_SAMPLE_S, (4, 6)).iter().map(|limit| limit.directions.nrows()).sum();
        assert_eq!(sides, POSITION_BOUNDS);
        let limits = Limits::default();
        let bounds = |asked: Asked| position_bounds(&limits, (5.0, 4.0), &asked, TurnUnderWay::default());
        let known = bounds(Asked { speed_m_s: 3.0, ..Asked::default() });
        assert!(known[..SIDES].iter().all(|bound| *bound == 5.0));
        assert!(known[SIDES..2 * SIDES].iter().all(|bound| *bound == 4.0));
        // Before the attitude loop has answered, and from then on.
        let (before, leaning_before) = (TURNING_AT - COARSE_SIDES, LEANING_AT - COARSE_SIDES);
        let (rate, acceleration) = (limits.tilt_rate_rad_s, limits.tilt_acceleration_rad_s2);
        assert_eq!([known[before], known[TURNING_AT]], [GRAVITY_M_S2 * acceleration; 2]);
        assert_eq!(known[leaning_before], 1.1 * (GRAVITY_M_S2 * rate));
        assert_eq!(known[LEANING_AT], GRAVITY_M_S2 * rate);
        assert_eq!(known[POSITION_BOUNDS - 1], 0.995 * 8.0);
        let streamed = bounds(Asked { speed_m_s: 3.0, is_streamed: true, ..Asked::default() });
        for (bound, (streamed, known)) in streamed.iter().zip(&known).enumerate() {
            let before_an_answer =
                (before..TURNING_AT).contains(&bound) || (leaning_before..LEANING_AT).contains(&bound);
            assert_eq!(*streamed, if before_an_answer { UNBOUNDED } else { *known });
        }
    }

    /// The delays of the heavy preset, the default and the Crazyflie.
    #[test]
    fn jerk_and_snap_are_split_where_the_attitude_has_answered() {
        for (delay_s, sample) in [(0.143, 3), (0.219, 4), (0.275, 6)] {
            assert_eq!(first_answered(delay_s, TRANSLATION_SAMPLE_S), sample);
            let limits = position_limits(TRANSLATION_SAMPLE_S, (sample, 6));
            for before in [&limits[2], &limits[4]] {
                assert!(before.samples.iter().all(|limited| *limited < sample), "{:?}", before.samples);
            }
            for from_then_on in [&limits[3], &limits[5]] {
                assert!(from_then_on.samples.iter().all(|limited| *limited >= sample));
            }
        }
    }

    #[test]
    fn a_speed_is_limited_from_when_the_attitude_has_answered() {
        let of = |kind: ControllerKind, sample_time_s: f64| {
            [0.01, 0.103, 0.143, 0.218, 0.277].map(|delay_s| first_moving(kind, delay_s, sample_time_s))
        };
        assert_eq!(of(ControllerKind::Lmpc, 0.05), [4, 4, 6, 6, 8]);
        assert_eq!(of(ControllerKind::Lmpc, 0.02), [5, 10, 15, 15, 20]);
        assert_eq!(of(ControllerKind::Lmpc, 0.15), [1, 2, 2, 2, 3]);
        assert_eq!(of(ControllerKind::StateSpaceMpc, 0.05), [4; 5]);
        assert_eq!(moving(4, 0.05), [4, 7, 10, 13, 16, 20, 26, 34, 50, 80]);
        assert_eq!(moving(6, 0.05), [6, 8, 10, 13, 16, 20, 26, 34, 50, 80]);
        assert_eq!(moving(8, 0.05), [8, 10, 13, 16, 20, 26, 34, 50, 80]);
        assert_eq!(moving(15, 0.02), [15, 17, 20, 26, 34, 50, 80]);
        assert_eq!(moving(2, 0.2), [2, 3, 4, 5, 7, 9, 13, 20]);
        assert_eq!(moving(100, 0.05), [100, 102]);
    }

    /// What is under way is not forbidden; what is slower than the limit changes nothing.
    #[test]
    fn a_turn_under_way_may_go_on() {
        let limits = Limits::default();
        let turning = GRAVITY_M_S2 * limits.tilt_acceleration_rad_s2;
        for (share, expected) in [(0.5, 1.0), (1.0, 1.0), (3.0, 3.0)] {
            let under_way = TurnUnderWay { snap_m_s4: share * turning, ..TurnUnderWay::default() };
            assert_eq!(
                position_bounds(&limits, (5.0, 4.0), &Asked::default(), under_way)[TURNING_AT],
                expected * turning
            );
        }
    }

    /// The jerk of a body that was thrown may go on; a slower one changes nothing.
    #[test]
    fn a_thrown_body_may_come_back() {
        let limits = Limits::default();
        let leaning = GRAVITY_M_S2 * limits.tilt_rate_rad_s;
        for (share, expected) in [(0.5, 1.0), (1.0, 1.0), (3.0, 3.0)] {
            let under_way = TurnUnderWay { jerk_m_s3: share * leaning, ..TurnUnderWay::default() };
            let bounds = position_bounds(&limits, (5.0, 4.0), &Asked::default(), under_way);
            assert_eq!(bounds[LEANING_AT], expected * leaning);
        }
    }

    /// A reference that limits bend leaves feedback room where it turns near them or faster, any other that is faster; what is slower changes
    /// nothing.
    #[test]
    fn a_fast_turn_moves_the_limits_of_the_tilt() {
        let limits = Limits::default();
        let [leaning, turning] =
            [limits.tilt_rate_rad_s, limits.tilt_acceleration_rad_s2].map(|limit| GRAVITY_M_S2 * limit);
        for (share, most) in [(0.4, 1.0), (0.9, 1.4), (1.5, 2.0)] {
            let (jerk_m_s3, snap_m_s4) = (share * leaning, share * turning);
            let bounds = |asked: Asked| {
                let asked = Asked { jerk_m_s3, snap_m_s4, ..asked };
                let bounds = position_bounds(&limits, (5.0, 4.0), &asked, TurnUnderWay::default());
                [bounds[LEANING_AT] / leaning, bounds[TURNING_AT] / turning]
            };
            let near = |bounds: [f64; 2], expected: [f64; 2]| {
                bounds.iter().zip(expected).all(|(bound, expected)| (bound - expected).abs() < 1e-12)
            };
            let turned = if share > 1.0 { share + 0.1 } else { 1.0 };
            assert!(near(bounds(Asked { is_bent: true, ..Asked::default() }), [most, turned]));
            assert!(near(bounds(Asked { is_streamed: true, ..Asked::default() }), [turned; 2]));
            assert!(near(bounds(Asked::default()), [turned; 2]));
        }
    }

    /// So much of a narrowed way is followed.
    #[test]
    fn a_narrowed_way_may_turn_as_fast_as_it_is_followed() {
        let limits = Limits::default();
        let asked = Asked { is_bent: true, is_narrow: true, ..Asked::default() };
        let bounds = position_bounds(&limits, (5.0, 4.0), &asked, TurnUnderWay::default());
        let turning = bounds[TURNING_AT] / (GRAVITY_M_S2 * limits.tilt_acceleration_rad_s2);
        let leaning = bounds[LEANING_AT] / (GRAVITY_M_S2 * limits.tilt_rate_rad_s);
        assert!((turning - 1.3).abs() < 1e-12 && (leaning - 1.3).abs() < 1e-12, "{turning} {leaning}");
    }

    /// A reference that is faster than the limit may be caught up with.
    #[test]
    fn a_fast_reference_moves_the_speed_limit() {
        let speed = |speed_m_s: f64| {
            let asked = Asked { speed_m_s, ..Asked::default() };
            position_bounds(&Limits::default(), (5.0, 5.0), &asked, TurnUnderWay::default())
                [POSITION_BOUNDS - 1]
        };
        // At the limit by one per cent of it.
        assert!((speed(8.0) - 0.995 * 8.08).abs() < 1e-12);
        assert!((speed(10.0) - 0.995 * 10.8).abs() < 1e-12);
        let of_bent = |asked: Asked| {
            position_bounds(&Limits::default(), (5.0, 5.0), &asked, TurnUnderWay::default())
                [POSITION_BOUNDS - 1]
        };
        for (speed_m_s, most_m_s) in [(6.0, 8.0), (7.5, 9.1), (10.0, 11.6)] {
            for is_narrow in [false, true] {
                let bent = Asked { speed_m_s, is_bent: true, is_narrow, ..Asked::default() };
                assert!((of_bent(bent) - 0.995 * most_m_s).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn far_goals_are_seen_at_the_horizon() {
        let planned = |kind: ControllerKind| planned_horizon_m(kind, 8.0, 4.0, 2.5);
        assert!((planned(ControllerKind::Lmpc) - (3.2 + 10.4)).abs() < 1e-12);
        assert!((planned(ControllerKind::StateSpaceMpc) - (8.0 + 10.4)).abs() < 1e-12);
        let horizon = horizon_m(8.0, 4.0);
        assert!((horizon - (16.0 + 9.6)).abs() < 1e-12);
        let near = Vector2::new(3.0, -4.0);
        assert_eq!(in_sight(&near, horizon), near);
        let far = in_sight(&Vector2::new(-3e300, 4e300), 5.0);
        assert!((far - Vector2::new(-3.0, 4.0)).norm() < 1e-12, "{far}");
    }
}
