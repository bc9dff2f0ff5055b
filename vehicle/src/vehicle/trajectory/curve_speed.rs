//! How fast a curve may be flown.
//!
//! ```text
//!  limits of speed, curvature and bend at each place ──► none faster within a time before and after it
//!                                                    ──► room to brake ──► squares of speeds, evenly along the curve
//! ```

use libm::{cbrt, sqrt};
use nalgebra::Vector3;
use quadrotor::Limits;

use super::curve_piece::{CurvePiece, CurvePoint};
use super::direction_limits::limits_along;
use super::eased_speed::EASED_S;

/// Parts of a piece at which its limits are looked at, at least and at most, and of the way that is kept.
const LOOKS: (usize, usize) = (32, 512);
const PARTS: usize = 64;
/// Share of the horizontal acceleration that turns the velocity, of the vertical one, and of that which changes its size.
const CENTRIPETAL: f64 = 0.4;
const CENTRIPETAL_VERTICAL: f64 = 0.85;
const TANGENTIAL: f64 = 0.2;
const TANGENTIAL_VERTICAL: f64 = 0.5;
/// Share of the jerk for either of them, and for what the one does to the other.
const JERK: f64 = 0.5;
const CROSSED_JERK: f64 = 0.36;
/// The way that is kept beyond the piece, s at its fastest: what leads the eased motion, and a look ahead.
const BEYOND_S: f64 = EASED_S;

/// The fastest along a piece of a curve and a little beyond it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveSpeed {
    /// Length of the piece, m.
    pub length_m: f64,
    /// Acceleration along the curve that it counts on, m/s².
    pub acceleration_m_s2: f64,
    /// Where a rest is planned, m from the beginning of the piece.
    pub rest_m: f64,
    /// Between two of the squares, m.
    spacing_m: f64,
    /// Squares of the fastest, m²/s², from the beginning of the piece on.
    squares_m2_s2: [f64; PARTS + 1],
}

/// A look at the fastest.
#[derive(Clone, Copy)]
struct Look {
    /// From the beginning of the curve, m.
    along_m: f64,
    fastest_m_s: f64,
}

impl CurveSpeed {
    /// Along the first of some pieces that follow one another; it comes to rest at the end of the last one.
    pub fn new(pieces: &[CurvePiece], limits: &Limits) -> Self {
        let acceleration_m_s2 = (TANGENTIAL * limits.acceleration_horizontal_m_s2)
            .min(TANGENTIAL_VERTICAL * limits.acceleration_vertical_m_s2)
            // It may turn round within the time over which it is eased.
            .min(JERK * limits.jerk_horizontal_m_s3.min(limits.jerk_vertical_m_s3) * EASED_S / 2.0);
        let mut looks = Vec::with_capacity(pieces.len() * (LOOKS.0 + 1));
        let (mut along_m, mut length_m) = (0.0, 0.0);
        for (index, piece) in pieces.iter().enumerate() {
            look_along(piece, limits, acceleration_m_s2, &mut along_m, &mut looks);
            if index == 0 {
                length_m = along_m;
            }
        }
        spread(&mut looks);
        leave_room_to_brake(&mut looks, acceleration_m_s2);
        let fastest_m_s = looks.iter().map(|look| look.fastest_m_s).fold(0.0, f64::max);
        let spacing_m = along_m.min(length_m + BEYOND_S * fastest_m_s) / PARTS as f64;
        let mut squares_m2_s2 = sampled(&looks, spacing_m);
        lower_between(&looks, spacing_m, &mut squares_m2_s2);
        for part in (0..PARTS).rev() {
            let reached_m2_s2 = squares_m2_s2[part + 1] + 2.0 * acceleration_m_s2 * spacing_m;
            squares_m2_s2[part] = squares_m2_s2[part].min(reached_m2_s2);
        }
        Self { length_m, acceleration_m_s2, rest_m: along_m, spacing_m, squares_m2_s2 }
    }

    /// The fastest so far from the beginning of the piece, m/s.
    pub fn fastest_m_s(&self, along_m: f64) -> f64 {
        let place = (along_m / self.spacing_m).clamp(0.0, PARTS as f64);
        let part = (place as usize).min(PARTS - 1);
        match self.squares_m2_s2.get(part..part + 2) {
            // Speeds under a constant acceleration: their squares are even.
            Some([here, next]) if place.is_finite() => sqrt(here + (next - here) * (place - part as f64)),
            _ => 0.0,
        }
    }
}

fn look_along(
    piece: &CurvePiece,
    limits: &Limits,
    acceleration_m_s2: f64,
    along_m: &mut f64,
    looks: &mut Vec<Look>,
) {
    let parts = piece.parts(LOOKS);
    let at = |part: usize| part as f64 / parts as f64;
    for part in 0..=parts {
        if part > 0 {
            *along_m += piece.length_m(at(part - 1), at(part));
        }
        let fastest_m_s = fastest_m_s(&piece.at(at(part)), acceleration_m_s2, limits);
        looks.push(Look { along_m: *along_m, fastest_m_s });
    }
}

/// The fastest that the limits allow at a place, m/s, under an acceleration along the curve, m/s²: of the jerk v³ dκ/ds and 3 v a κ have
/// their shares.
fn fastest_m_s(point: &CurvePoint, acceleration_m_s2: f64, limits: &Limits) -> f64 {
    let within = |limit: f64, size: f64| if size > 1e-9 { limit / size } else { f64::INFINITY };
    let sideways = Limits {
        acceleration_horizontal_m_s2: CENTRIPETAL * limits.acceleration_horizontal_m_s2,
        acceleration_vertical_m_s2: (CENTRIPETAL_VERTICAL * limits.acceleration_vertical_m_s2)
            .min(CENTRIPETAL * limits.acceleration_horizontal_m_s2),
        ..*limits
    };
    let along =
        |vector: &Vector3<f64>| limits_along(&vector.try_normalize(0.0).unwrap_or_default(), &sideways);
    along(&point.direction)
        .speed
        .min(sqrt(within(along(&point.curvature).acceleration, point.curvature.norm())))
        .min(within(
            CROSSED_JERK * along(&point.curvature).jerk,
            3.0 * acceleration_m_s2 * point.curvature.norm(),
        ))
        .min(cbrt(within(JERK * along(&point.bend).jerk, point.bend.norm())))
}

/// Eased, a speed is a mean over a time. So that it is within the limit of each place, nothing within half that time of a place is
/// faster than there.
fn spread(looks: &mut [Look]) {
    let limits: Vec<Look> = looks.to_vec();
    let spread = |look: &mut Look, others: &mut dyn Iterator<Item = &Look>| {
        for other in others {
            let reached_m_s = (other.along_m - look.along_m).abs() / (EASED_S / 2.0);
            if reached_m_s >= look.fastest_m_s {
                break;
            }
            look.fastest_m_s = look.fastest_m_s.min(other.fastest_m_s.max(reached_m_s));
        }
    };
    for (index, look) in looks.iter_mut().enumerate() {
        let (before, after) = limits.split_at(index);
        spread(look, &mut before.iter().rev());
        spread(look, &mut after.iter());
    }
}

fn leave_room_to_brake(looks: &mut [Look], braking_m_s2: f64) {
    let mut next: Option<Look> = None;
    for look in looks.iter_mut().rev() {
        let reached_m2_s2 = next.map_or(0.0, |next| {
            next.fastest_m_s * next.fastest_m_s + 2.0 * braking_m_s2 * (next.along_m - look.along_m)
        });
        look.fastest_m_s = look.fastest_m_s.min(sqrt(reached_m2_s2));
        next = Some(*look);
    }
}

/// Squares of the fastest, evenly along the curve.
fn sampled(looks: &[Look], spacing_m: f64) -> [f64; PARTS + 1] {
    let mut next = 0;
    core::array::from_fn(|part| {
        let along_m = spacing_m * part as f64;
        while looks.get(next).is_some_and(|look| look.along_m < along_m) {
            next += 1;
        }
        let after = looks.get(next).or(looks.last());
        let before = looks.get(next.saturating_sub(1));
        let (Some(before), Some(after)) = (before, after) else { return 0.0 };
        let [low, high] = [before, after].map(|look| look.fastest_m_s * look.fastest_m_s);
        let apart_m = after.along_m - before.along_m;
        let share = if apart_m > 0.0 { (along_m - before.along_m) / apart_m } else { 1.0 };
        low + (high - low) * share.clamp(0.0, 1.0)
    })
}

/// Lowers squares between which the fastest is slower than evenly between them.
fn lower_between(looks: &[Look], spacing_m: f64, squares_m2_s2: &mut [f64; PARTS + 1]) {
    for look in looks {
        let place = look.along_m / spacing_m;
        let part = place as usize;
        let Some([here, next]) = squares_m2_s2.get_mut(part..part.saturating_add(2)) else { break };
        let even_m2_s2 = *here + (*next - *here) * (place - part as f64);
        let excess_m2_s2 = even_m2_s2 - look.fastest_m_s * look.fastest_m_s;
        if excess_m2_s2 > 0.0 {
            *here = (*here - excess_m2_s2).max(0.0);
            *next = (*next - excess_m2_s2).max(0.0);
        }
    }
}
