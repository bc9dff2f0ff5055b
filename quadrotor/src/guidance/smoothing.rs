//! What rounds off the jumps of a jerk-limited motion.
//!
//! Jerk is a rate of the tilt, and its jumps are kicks that no torque can make. The mean of the motion over a window T₁ and of that over a
//! window T₂ has a snap of at most S = 2j/T₁, which changes within T₂, and keeps all limits of the motion. The rotors make what they are
//! asked for after a delay τ. To change the snap by S within T₂ they are asked for S (1 + τ/T₂), which must not be more than what
//! the largest angular acceleration α of the tilt makes:
//!
//! ```text
//! T₀ = 2j/(g α)     T₁ = T₀ (1 + τ/T₂)     T₂ = √(T₀ τ)
//! ```
//!
//! This T₂ makes T₁ + T₂, by which the motion ends later, as short as it can be.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::design::response_times::ResponseTimes;
use crate::guidance::motion_profile::{Motion, MotionProfile};
use crate::{Configuration, GRAVITY_M_S2, Limits, PositionReference};

/// Two means, one of the other, over windows of the past.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Smoothing {
    /// T₁ and T₂, s; both 0 leave a motion as it is.
    windows_s: [f64; 2],
}

impl Smoothing {
    /// Of a motion that keeps limits.
    pub fn new(limits: &Limits, times: &ResponseTimes) -> Self {
        let kick_s = 2.0 * limits.jerk_horizontal_m_s3 / (GRAVITY_M_S2 * limits.tilt_acceleration_rad_s2);
        let second_s = libm::sqrt(kick_s * times.torque_delay_s).max(times.sample_time_s);
        Self { windows_s: [kick_s * (1.0 + times.torque_delay_s / second_s), second_s] }
    }

    /// How much of the past counts, s.
    pub fn reach_s(&self) -> f64 {
        self.windows_s[0] + self.windows_s[1]
    }

    /// The motion under constant acceleration whose smoothed motion is this one now. It is ahead of it.
    ///
    /// ```text
    /// v = v̄ + a μ,  p = p̄ + v μ − a (μ² + σ²)/2
    /// ```
    pub fn leading(&self, smoothed: &PositionReference) -> PositionReference {
        let (mean_s, variance_s2) = self.moments();
        let velocity_m_s = smoothed.velocity_m_s + smoothed.acceleration_m_s2 * mean_s;
        let curved = smoothed.acceleration_m_s2 * ((mean_s * mean_s + variance_s2) / 2.0);
        let position_m = smoothed.position_m + velocity_m_s * mean_s - curved;
        let zero = Vector3::zeros();
        PositionReference { position_m, velocity_m_s, jerk_m_s3: zero, snap_m_s4: zero, ..*smoothed }
    }

    /// A motion under constant jerk, smoothed, `time_s` after it was `from`.
    pub fn of_constant_jerk(&self, from: &PositionReference, time_s: f64) -> PositionReference {
        let (mean_s, variance_s2) = self.moments();
        let middle = PositionReference { snap_m_s4: Vector3::zeros(), ..*from }.after(time_s - mean_s);
        let curved = variance_s2 / 2.0;
        PositionReference {
            position_m: middle.position_m + middle.acceleration_m_s2 * curved,
            velocity_m_s: middle.velocity_m_s + middle.jerk_m_s3 * curved,
            ..middle
        }
    }

    /// A profile at a time, s, smoothed: position, velocity, acceleration, jerk and snap. Its first piece counts as having lasted for long.
    pub fn of(&self, profile: &MotionProfile, time_s: f64) -> [f64; 5] {
        let (mean_s, variance_s2) = self.moments();
        let begin_s = time_s - self.reach_s();
        let pieces = profile.pieces();
        let first = pieces.iter().rposition(|(start_s, _)| *start_s <= begin_s).unwrap_or(0);
        let Some((start_s, piece)) = pieces.get(first) else { return [0.0; 5] };
        if first + 1 == pieces.len() && piece.rests() {
            return [piece.position, 0.0, 0.0, 0.0, 0.0];
        }
        let middle = piece.after(time_s - mean_s - start_s);
        let curved = variance_s2 / 2.0;
        let Motion { position, velocity, acceleration, jerk } = middle;
        let goes_on = [position + acceleration * curved, velocity + jerk * curved, acceleration, jerk, 0.0];
        // The piece with which the windows begin goes on, and each later one adds the jump of its jerk.
        sum(goes_on, self.of_jumps(profile, first, time_s))
    }

    /// What the jumps of the jerk after a piece of a profile have made of its derivatives until a time, s.
    // Its sums stay in registers: read back together from where they were stored one by one, they would have to wait.
    #[inline(always)]
    pub fn of_jumps(&self, profile: &MotionProfile, first: usize, time_s: f64) -> [f64; 5] {
        let mut made = [0.0; 5];
        for (start_s, jump) in profile.jumps(first) {
            let since_s = time_s - start_s;
            // Later ones are still to come.
            if since_s <= 0.0 {
                break;
            }
            // Along an axis on which nothing moves there are none.
            if jump == 0.0 {
                continue;
            }
            made = sum(made, self.step(since_s).map(|part| jump * part));
        }
        made
    }

    /// What a jump of the jerk by 1 makes of position, velocity, acceleration, jerk and snap a time t > 0 later, s:
    ///
    /// ```text
    /// [tⁿ − (t − T₁)ⁿ − (t − T₂)ⁿ + (t − T₁ − T₂)ⁿ]/(n! T₁ T₂),  n = 5 … 1,  without what is negative in brackets
    /// ```
    pub fn step(&self, time_s: f64) -> [f64; 5] {
        let [first_s, second_s] = self.windows_s;
        // Without windows there are no jumps, but compilers divide before they know.
        let share = 1.0 / (first_s * second_s).max(f64::MIN_POSITIVE);
        // Corner by corner side by side: what is negative in brackets counts as zero.
        let mut terms = [share, -share, -share, share];
        let since_s = [0.0, first_s, second_s, first_s + second_s].map(|corner_s| {
            let since_s = time_s - corner_s;
            if since_s > 0.0 { since_s } else { 0.0 }
        });
        let mut parts = [0.0; 5];
        // Products take less time than divisions.
        for (part, per_order) in parts.iter_mut().rev().zip([1.0, 1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0, 1.0 / 5.0])
        {
            for (term, since_s) in terms.iter_mut().zip(since_s) {
                *term *= since_s * per_order;
            }
            *part = terms[0] + terms[1] + terms[2] + terms[3];
        }
        parts
    }

    /// How late the smoothed motion is, s, and the variance of what counts about that, s².
    fn moments(&self) -> (f64, f64) {
        let [first_s, second_s] = self.windows_s;
        ((first_s + second_s) / 2.0, (first_s * first_s + second_s * second_s) * (1.0 / 12.0))
    }
}

impl Configuration {
    /// How much later shaped motions are than jerk-limited ones that begin alike, s: they are smoothed.
    pub fn shaping_delay_s(&self) -> f64 {
        Smoothing::new(&self.limits, &self.response_times()).moments().0
    }
}

fn sum(one: [f64; 5], other: [f64; 5]) -> [f64; 5] {
    core::array::from_fn(|part| one[part] + other[part])
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use proptest::prelude::*;

    use super::Smoothing;
    use crate::design::response_times::ResponseTimes;
    use crate::guidance::motion_profile::{Motion, MotionProfile};
    use crate::{GRAVITY_M_S2, Limits, PositionReference};

    const TIMES: ResponseTimes = ResponseTimes { torque_delay_s: 0.035, sample_time_s: 0.05 };

    /// A motion before, and pieces of constant jerk that continue it, with their durations, s.
    fn profile(pieces: &[(f64, f64)]) -> MotionProfile {
        let mut now = Motion { position: 3.0, velocity: -0.5, acceleration: 0.7, jerk: 1.5 };
        let mut profile = MotionProfile::constant(now);
        let mut time_s = 0.0;
        for (duration_s, jerk) in pieces {
            now = Motion { jerk: *jerk, ..profile.at(time_s) };
            profile.push(time_s, now);
            time_s += duration_s;
        }
        let end = Motion { jerk: 0.0, ..profile.at(time_s) };
        profile.push(time_s, end);
        profile
    }

    proptest! {
        /// The oracle is the mean of means by the trapezoidal rule, whose error falls with the square of its step.
        #[test]
        fn it_is_the_mean_of_means(
            pieces in prop::collection::vec((0.02..0.5, -4.0..4.0), 1..6), time_s in 0.3..3.0,
        ) {
            const STEPS: u32 = 200;
            let smoothing = Smoothing::new(&Limits::default(), &TIMES);
            let profile = profile(&pieces);
            let mean = |of: &dyn Fn(f64) -> f64, window_s: f64, until_s: f64| {
                let at = |step: u32| of(until_s - window_s * f64::from(step) / f64::from(STEPS));
                ((1..STEPS).map(at).sum::<f64>() + (at(0) + at(STEPS)) / 2.0) / f64::from(STEPS)
            };
            let [first_s, second_s] = smoothing.windows_s;
            let parts: [fn(&Motion) -> f64; 3] =
                [|motion| motion.position, |motion| motion.velocity, |motion| motion.acceleration];
            for (part, found) in parts.into_iter().zip(smoothing.of(&profile, time_s)) {
                let inner = |until_s: f64| mean(&|at_s| part(&profile.at(at_s)), first_s, until_s);
                let expected = mean(&inner, second_s, time_s);
                prop_assert!((found - expected).abs() < 1e-5, "{found} {expected}");
            }
        }

        /// Central differences of each derivative give the next one.
        #[test]
        fn its_parts_are_derivatives(
            pieces in prop::collection::vec((0.02..0.5, -4.0..4.0), 1..6), time_s in 0.3..3.0,
        ) {
            const H: f64 = 1e-4;
            let smoothing = Smoothing::new(&Limits::default(), &TIMES);
            let profile = profile(&pieces);
            let [before, now, after] = [-H, 0.0, H].map(|off_s| smoothing.of(&profile, time_s + off_s));
            // The snap has corners; the crackle between them is at most 8 m/s³ over T₁ T₂.
            for (order, bar) in [1e-6, 1e-6, 1e-5, 0.2].into_iter().enumerate() {
                let slope = (after[order] - before[order]) / (2.0 * H);
                prop_assert!((slope - now[order + 1]).abs() < bar, "{order}: {slope} {now:?}");
            }
        }

        /// What leads a motion is smoothed to it.
        #[test]
        fn a_leading_motion_is_smoothed_to_the_one_it_leads(
            [p, v, a] in prop::array::uniform3(-5.0..5.0_f64), delay_s in 0.005..0.2,
        ) {
            let times = ResponseTimes { torque_delay_s: delay_s, ..TIMES };
            let smoothing = Smoothing::new(&Limits::default(), &times);
            let along = |value: f64| Vector3::x() * value;
            let now = PositionReference {
                velocity_m_s: along(v),
                acceleration_m_s2: along(a),
                ..PositionReference::goal([p, 0.0, 0.0], 0.0)
            };
            let found = smoothing.of_constant_jerk(&smoothing.leading(&now), 0.0);
            let off = [found.position_m - now.position_m, found.velocity_m_s - now.velocity_m_s];
            prop_assert!(off.iter().all(|off| off.norm() < 1e-12), "{found:?}");
            prop_assert_eq!(found.acceleration_m_s2, now.acceleration_m_s2);
        }

        /// Whatever the delay of the torques, the rotors are asked for no more than α: S (1 + τ/T₂) ≤ g α.
        #[test]
        fn the_rotors_are_asked_for_no_more_than_there_is(delay_s in 0.005..0.3, jerk in 0.5..20.0) {
            let limits = Limits { jerk_horizontal_m_s3: jerk, ..Limits::default() };
            let times = ResponseTimes { torque_delay_s: delay_s, ..TIMES };
            let smoothing = Smoothing::new(&limits, &times);
            let profile = profile(&[(1.0, 0.0), (0.5, jerk), (2.0, -jerk)]);
            let snaps = (0..2_000).map(|step| smoothing.of(&profile, 1.0 + f64::from(step) * 1e-3)[4]);
            let largest = snaps.fold(0.0, |largest: f64, snap| largest.max(snap.abs()));
            let asked = largest * (1.0 + delay_s / smoothing.windows_s[1]);
            prop_assert!(asked <= GRAVITY_M_S2 * limits.tilt_acceleration_rad_s2 * (1.0 + 1e-9), "{asked}");
        }
    }

    /// Rest is rest, exactly; without windows a motion is what it is.
    #[test]
    fn rest_and_an_empty_smoothing_change_nothing() {
        let smoothing = Smoothing::new(&Limits::default(), &TIMES);
        assert_eq!(smoothing.of(&MotionProfile::constant(Motion::at(7.3)), 2.0), [7.3, 0.0, 0.0, 0.0, 0.0]);
        let profile = profile(&[(0.3, 2.0), (0.4, -3.0)]);
        for time_s in [0.1, 0.3, 0.5, 2.0] {
            let Motion { position, velocity, acceleration, jerk } = profile.at(time_s);
            let same = [position, velocity, acceleration, jerk, 0.0];
            assert_eq!(Smoothing::default().of(&profile, time_s), same);
        }
    }
}
