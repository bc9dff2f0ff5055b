//! A motion beside points of which some derivatives are estimated.
//!
//! An estimated derivative is off by noise, and by what the samples do not tell yet. Then it is not the derivative of the one before it, and a
//! law that takes position, velocity, acceleration, jerk and snap for one motion answers with a lasting distance: with all its poles at
//! −μ, an error δ of the jerk costs 10 δ/μ³. So it is given a motion x beside the points y, from which it leaves as it entered, and
//! whose difference from them fades with poles that are faster than those of the law:
//!
//! ```text
//! (d/dt + λ)⁵ (x − y) = 0
//! ```
//!
//! Between two samples y moves on by its derivatives. An error δ of its jerk costs 10 δ/λ³ of x, which is a motion and is followed.
//!
//! Where noise makes y jump at its samples, a fast λ makes snap of it that no vehicle can follow, so λ is as slow as the jumps ask for.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::{GRAVITY_M_S2, Limits, PositionReference};

/// λ of points without noise, rad/s, and the slowest one: slower ways lag behind their points.
const RATE_RAD_S: f64 = 8.0;
const SLOWEST_RAD_S: f64 = 3.0;
/// The snap that jumps may make, as a share of the one that the limit of tilt acceleration allows, and the limit, rad/s², beyond which that
/// grows no more: rotors may have less than a limit that is wide open.
const OF_LIMIT: f64 = 0.2;
const LIMIT_RAD_S2: f64 = 8.0;
/// The largest snap while a jump of one derivative alone fades, from the position to the jerk: times the jump and λ⁴, λ³, λ² or λ.
const SNAP_OF_JUMP: [f64; ORDERS - 1] = [0.13, 0.69, 1.49, 1.72];
/// How long, s, jumps are remembered.
const REMEMBERED_S: f64 = 2.0;
/// Less snap than that, m/s⁴, is not divided by.
const LEAST_M_S4: f64 = 1e-9;
/// A difference that fades with so many times the acceleration of the largest tilt is another motion, not an error.
const ANOTHER: f64 = 2.0;
/// Position and its derivatives up to the snap.
const ORDERS: usize = 5;
/// n over k: k from 0 to n.
const BINOMIALS: [[f64; ORDERS]; ORDERS] = [
    [1.0, 0.0, 0.0, 0.0, 0.0],
    [1.0, 1.0, 0.0, 0.0, 0.0],
    [1.0, 2.0, 1.0, 0.0, 0.0],
    [1.0, 3.0, 3.0, 1.0, 0.0],
    [1.0, 4.0, 6.0, 4.0, 1.0],
];

/// A vector and its derivatives.
type Derivatives = [Vector3<f64>; ORDERS];

/// The motion, as it is beside the latest points; none without any.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct ConsistentWay {
    latest: Option<Beside>,
}

/// What is left of a difference from a point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Beside {
    point: PositionReference,
    difference: Derivatives,
    time_us: u64,
    /// How far the points have jumped lately, from the position to the jerk.
    jumped: [f64; ORDERS - 1],
    /// The largest snap that the points have had lately.
    asked_m_s4: f64,
    /// λ
    rate_rad_s: f64,
}

impl ConsistentWay {
    /// The next point begins another motion.
    pub fn forget(&mut self) {
        self.latest = None;
    }

    /// The points are elsewhere, m, and the motion with them.
    pub fn shift(&mut self, by_m: &Vector3<f64>) {
        self.latest.iter_mut().for_each(|latest| latest.point.position_m += by_m);
    }

    /// The motion at the time of a point. It begins with the first one, and anew where it cannot come to the point soon.
    pub fn beside(&mut self, point: &PositionReference, limits: &Limits, time_us: u64) -> PositionReference {
        let most_m_s2 = ANOTHER * GRAVITY_M_S2 * libm::tan(limits.tilt_rad);
        let next = self
            .latest
            .map(|before| before.next(point, limits, time_us))
            .filter(|next| next.fading_m_s2() <= most_m_s2)
            .unwrap_or_else(|| Beside::none(point, time_us));
        self.latest = Some(next);
        let [position_m, velocity_m_s, acceleration_m_s2, jerk_m_s3, snap_m_s4] = next.difference;
        PositionReference {
            position_m: point.position_m + position_m,
            velocity_m_s: point.velocity_m_s + velocity_m_s,
            acceleration_m_s2: point.acceleration_m_s2 + acceleration_m_s2,
            jerk_m_s3: point.jerk_m_s3 + jerk_m_s3,
            snap_m_s4: point.snap_m_s4 + snap_m_s4,
            ..*point
        }
    }
}

impl Beside {
    /// No difference.
    fn none(point: &PositionReference, time_us: u64) -> Self {
        let difference = [Vector3::zeros(); ORDERS];
        Self {
            point: *point,
            difference,
            time_us,
            jumped: [0.0; ORDERS - 1],
            asked_m_s4: 0.0,
            rate_rad_s: RATE_RAD_S,
        }
    }

    /// What is left of it beside a later point.
    fn next(&self, point: &PositionReference, limits: &Limits, time_us: u64) -> Self {
        let elapsed_s = time_us.saturating_sub(self.time_us) as f64 / 1e6;
        let [expected, now] = [self.point.after(elapsed_s), *point].map(|point| derivatives(&point));
        let jump: Derivatives = core::array::from_fn(|order| expected[order] - now[order]);
        let faded = faded(&self.difference, self.rate_rad_s, elapsed_s);
        let kept = libm::exp(-elapsed_s / REMEMBERED_S);
        let jumped = core::array::from_fn(|order| jump[order].norm().max(self.jumped[order] * kept));
        let asked_m_s4 = point.snap_m_s4.norm().max(self.asked_m_s4 * kept);
        Self {
            point: *point,
            difference: core::array::from_fn(|order| faded[order] + jump[order]),
            time_us,
            jumped,
            asked_m_s4,
            rate_rad_s: rate_rad_s(&jumped, asked_m_s4, limits),
        }
    }

    /// About the acceleration with which it fades, m/s².
    fn fading_m_s2(&self) -> f64 {
        let [position, velocity, acceleration, ..] = self.difference;
        let by_position = position * (self.rate_rad_s * self.rate_rad_s);
        let by_velocity = velocity * (2.0 * self.rate_rad_s);
        by_position.norm().max(by_velocity.norm()).max(acceleration.norm())
    }
}

/// The λ with which jumps make no more snap than they may, or than the points ask for themselves.
fn rate_rad_s(jumped: &[f64; ORDERS - 1], asked_m_s4: f64, limits: &Limits) -> f64 {
    let limit_rad_s2 = limits.tilt_acceleration_rad_s2.min(LIMIT_RAD_S2);
    let most_m_s4 = (OF_LIMIT * GRAVITY_M_S2 * limit_rad_s2).max(asked_m_s4);
    let [position, velocity, acceleration, jerk] =
        core::array::from_fn(|order| most_m_s4 / (SNAP_OF_JUMP[order] * jumped[order]).max(LEAST_M_S4));
    libm::sqrt(libm::sqrt(position))
        .min(libm::cbrt(velocity))
        .min(libm::sqrt(acceleration))
        .min(jerk)
        .clamp(SLOWEST_RAD_S, RATE_RAD_S)
}

fn derivatives(point: &PositionReference) -> Derivatives {
    [point.position_m, point.velocity_m_s, point.acceleration_m_s2, point.jerk_m_s3, point.snap_m_s4]
}

/// What is left of a difference after a time, s.
///
/// ```text
/// x − y = q e^(−λt)      q is of fourth degree
/// q⁽ⁿ⁾ = Σ (n over k) λⁿ⁻ᵏ (x − y)⁽ᵏ⁾ e^(λt)
/// ```
fn faded(difference: &Derivatives, rate_rad_s: f64, time_s: f64) -> Derivatives {
    let begun = turned(difference, rate_rad_s);
    let mut later = begun;
    for (order, derivative) in later.iter_mut().enumerate() {
        // Taylor's, which ends.
        let mut share = 1.0;
        for (more, higher) in begun.iter().skip(order + 1).enumerate() {
            share *= time_s / (more + 1) as f64;
            *derivative += higher * share;
        }
    }
    let left = libm::exp(-rate_rad_s * time_s);
    turned(&later, -rate_rad_s).map(|derivative| derivative * left)
}

/// The derivatives of f e^(rate t) at t = 0.
fn turned(of: &Derivatives, rate: f64) -> Derivatives {
    let mut powers = [1.0; ORDERS];
    for order in 1..ORDERS {
        powers[order] = powers[order - 1] * rate;
    }
    core::array::from_fn(|order| {
        let terms = of.iter().zip(BINOMIALS[order]).take(order + 1);
        terms.enumerate().fold(Vector3::zeros(), |sum, (low, (derivative, binomial))| {
            sum + derivative * (binomial * powers[order - low])
        })
    })
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use proptest::prelude::*;

    use super::{ConsistentWay, RATE_RAD_S, derivatives};
    use crate::guidance::known_motion;
    use crate::{Limits, PositionReference};

    const STEP_US: u64 = 10_000;

    /// A point of a circle of 4 m at 0.8 rad/s with an error of its jerk, m/s³, to the north.
    fn circle(time_us: u64, error_m_s3: f64) -> PositionReference {
        let whole = known_motion::circle(4.0, 0.8, time_us as f64 * 1e-6);
        PositionReference { jerk_m_s3: whole.jerk_m_s3 + Vector3::x() * error_m_s3, ..whole }
    }

    /// Points whose derivatives are right are the way.
    #[test]
    fn a_motion_is_its_own_way() {
        let mut way = ConsistentWay::default();
        for step in 0..500 {
            let point = circle(step * STEP_US, 0.0);
            let followed = way.beside(&point, &Limits::default(), step * STEP_US);
            // The fifth derivative, 1.3 m/s⁵, is not told.
            let off = [followed.position_m - point.position_m, followed.snap_m_s4 - point.snap_m_s4];
            assert!(off[0].norm() < 1e-3 && off[1].norm() < 0.3, "{off:?}");
        }
    }

    /// The oracle is the differential equation: with y off by δ in its jerk for ever, x⁗ = y⁗ + … has 10 λ² (x‴ − y‴) = λ⁵ (y − x) at rest.
    #[test]
    fn a_lasting_error_of_the_jerk_costs_ten_by_the_cube_of_the_rate() {
        let mut way = ConsistentWay::default();
        let mut off_m = Vector3::zeros();
        for step in 0..1_000 {
            let time_us = step * 1_000;
            let point = circle(time_us, 0.5);
            off_m = way.beside(&point, &Limits::default(), time_us).position_m - point.position_m;
        }
        let expected_m = 10.0 * 0.5 / (RATE_RAD_S * RATE_RAD_S * RATE_RAD_S);
        assert!((off_m.x.abs() / expected_m - 1.0).abs() < 0.15, "{off_m} {expected_m}");
    }

    proptest! {
        /// Whatever the errors, each derivative is that of the one before.
        #[test]
        fn the_way_is_a_motion(errors in prop::collection::vec(-0.5..0.5_f64, 40)) {
            let mut way = ConsistentWay::default();
            let mut before: Option<PositionReference> = None;
            for step in 0..400_u64 {
                let time_us = step * 1_000;
                let followed =
                    way.beside(&circle(time_us, errors[step as usize / 10]), &Limits::default(), time_us);
                if let Some(before) = before {
                    let [expected, now] = [before.after(1e-3), followed].map(|point| derivatives(&point));
                    for order in 0..4 {
                        let off = (expected[order] - now[order]).norm();
                        prop_assert!(off < 1e-4 * 10.0_f64.powi(order as i32), "{order}: {off}");
                    }
                }
                before = Some(followed);
            }
        }
    }

    /// A jump of one derivative alone, between what the fastest and the slowest λ may do, makes the snap that the limit leaves to jumps.
    #[test]
    fn jumps_make_no_more_snap_than_they_may() {
        let limits = Limits::default();
        let most_m_s4 = 0.2 * 9.80665 * limits.tilt_acceleration_rad_s2;
        for (order, jump) in [(0, 0.05), (1, 0.2), (2, 0.5), (3, 2.0)] {
            let mut way = ConsistentWay::default();
            let point = |is_after: bool| {
                let mut point = PositionReference::goal([0.0; 3], 0.0);
                let derivative = match order {
                    0 => &mut point.position_m,
                    1 => &mut point.velocity_m_s,
                    2 => &mut point.acceleration_m_s2,
                    _ => &mut point.jerk_m_s3,
                };
                derivative.x = if is_after { jump } else { 0.0 };
                point
            };
            let mut largest = 0.0_f64;
            for step in 0..3_000 {
                // The derivatives go on from the jump as those of one motion.
                let time_us = step * 1_000;
                let at = if step < 100 {
                    point(false)
                } else {
                    point(true).after(1e-6 * (time_us - 100_000) as f64)
                };
                largest = largest.max(way.beside(&at, &limits, time_us).snap_m_s4.norm());
            }
            assert!(largest < 1.05 * most_m_s4 && largest > 0.8 * most_m_s4, "{order}: {largest}");
        }
    }

    /// A point that is elsewhere at once is another motion, and is where it is.
    #[test]
    fn a_jump_is_no_error() {
        let (mut way, limits) = (ConsistentWay::default(), Limits::default());
        way.beside(&circle(0, 0.3), &limits, 0);
        let near = PositionReference { position_m: Vector3::new(4.1, 0.0, 0.0), ..circle(0, 0.0) };
        assert_ne!(way.beside(&near, &limits, STEP_US), near);
        let far = PositionReference { position_m: Vector3::new(9.0, 0.0, 0.0), ..near };
        assert_eq!(way.beside(&far, &limits, 2 * STEP_US), far);
    }
}
