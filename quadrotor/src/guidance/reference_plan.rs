//! The way that a reference is going to take.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::PositionReference;
use crate::attitude::wrapped;
use crate::guidance::heading::Heading;
use crate::guidance::motion_profile::{Motion, MotionProfile};

/// Most pieces of a plan: those of a straight line, and of a corner behind it.
const PIECES: usize = 16;

/// A motion in pieces of constant jerk, and a heading: what is known now of a reference that somebody else plans.
///
/// It is an input beside the reference, and the reference is a point of it. A control loop that knows it tracks it between the
/// samples of the reference, too, and looks ahead on it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReferencePlan {
    /// Time of the beginning of the way, µs.
    start_us: u64,
    /// When each piece begins, s after that, and its motion there; only the first `count` are used.
    pieces: [(f64, Piece); PIECES],
    count: usize,
    /// Time of the beginning of the turn, µs, and the turn.
    turn: (u64, MotionProfile),
}

/// Where a piece begins, in NED.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Piece {
    position_m: Vector3<f64>,
    velocity_m_s: Vector3<f64>,
    acceleration_m_s2: Vector3<f64>,
    jerk_m_s3: Vector3<f64>,
}

impl Piece {
    /// Where and how a reference moves.
    fn of(reference: &PositionReference) -> Self {
        Self {
            position_m: reference.position_m,
            velocity_m_s: reference.velocity_m_s,
            acceleration_m_s2: reference.acceleration_m_s2,
            jerk_m_s3: reference.jerk_m_s3,
        }
    }

    /// With a heading of zero.
    fn reference(&self) -> PositionReference {
        PositionReference {
            velocity_m_s: self.velocity_m_s,
            acceleration_m_s2: self.acceleration_m_s2,
            jerk_m_s3: self.jerk_m_s3,
            ..PositionReference::goal(self.position_m.into(), 0.0)
        }
    }
}

impl ReferencePlan {
    /// A plan that begins with a motion at a time, µs. It goes on under constant jerk and with the heading of that motion.
    pub fn new(start_us: u64, from: &PositionReference) -> Self {
        Self {
            start_us,
            pieces: [(0.0, Piece::of(from)); PIECES],
            count: 1,
            turn: (start_us, MotionProfile::constant(Motion::at(from.yaw_rad))),
        }
    }

    /// Goes on with another jerk from a motion on, so many seconds after the beginning, in place of what has been planned
    /// from there on. The seventeenth piece does not fit, and is not known.
    pub fn then(&mut self, start_s: f64, from: &PositionReference) {
        while self.count > 1 && self.pieces.get(self.count - 1).is_some_and(|(last_s, _)| *last_s >= start_s)
        {
            self.count -= 1;
        }
        if let Some(piece) = self.pieces.get_mut(self.count) {
            *piece = (start_s, Piece::of(from));
            self.count += 1;
        }
    }

    /// Turns as a profile does that begins at a time, µs.
    pub fn turning(self, start_us: u64, profile: MotionProfile) -> Self {
        Self { turn: (start_us, profile), ..self }
    }

    /// The point at a time, µs.
    pub fn at(&self, time_us: u64) -> PositionReference {
        let since_s = |start_us: u64| time_us.saturating_sub(start_us) as f64 / 1e6;
        let time_s = since_s(self.start_us);
        let used = self.pieces.get(..self.count).unwrap_or(&self.pieces);
        let (start_s, piece) =
            used.iter().rev().find(|(start_s, _)| *start_s <= time_s).unwrap_or(&self.pieces[0]);
        let (turn_us, profile) = &self.turn;
        let turn = profile.at(since_s(*turn_us));
        let heading = Heading {
            yaw_rad: turn.position,
            yaw_rate_rad_s: turn.velocity,
            yaw_acceleration_rad_s2: turn.acceleration,
        };
        heading.on(&piece.reference().after(time_s - start_s))
    }

    /// The same way elsewhere, m.
    pub(crate) fn shift(&mut self, by_m: &Vector3<f64>) {
        self.pieces.iter_mut().for_each(|(_, piece)| piece.position_m += by_m);
    }

    /// The same headings, counted so that the one at a time, µs, is nearest to an angle, rad.
    pub(crate) fn near_heading(self, yaw_rad: f64, time_us: u64) -> Self {
        let planned_rad = self.at(time_us).yaw_rad;
        let turns_rad = yaw_rad - planned_rad - wrapped(yaw_rad - planned_rad);
        let (turn_us, profile) = self.turn;
        self.turning(turn_us, profile.moved(turns_rad))
    }

    pub(crate) fn is_finite(&self) -> bool {
        let finite = |vector: &Vector3<f64>| vector.iter().all(|value| value.is_finite());
        let used = self.pieces.get(..self.count).unwrap_or(&self.pieces);
        self.turn.1.is_finite()
            && used.iter().all(|(start_s, piece)| {
                start_s.is_finite()
                    && [piece.position_m, piece.velocity_m_s, piece.acceleration_m_s2, piece.jerk_m_s3]
                        .iter()
                        .all(finite)
            })
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::ReferencePlan;
    use crate::PositionReference;
    use crate::guidance::motion_profile::{Motion, MotionProfile};

    fn moving(velocity: f64, jerk: f64) -> PositionReference {
        PositionReference {
            velocity_m_s: Vector3::x() * velocity,
            jerk_m_s3: Vector3::y() * jerk,
            ..PositionReference::goal([1.0, 0.0, -2.0], 0.3)
        }
    }

    #[test]
    fn pieces_follow_one_another_and_replace_what_comes_later() {
        let mut plan = ReferencePlan::new(1_000_000, &moving(2.0, 0.0));
        let joint = plan.at(2_000_000);
        assert_eq!((joint.position_m.x, joint.yaw_rad), (3.0, 0.3));
        plan.then(1.5, &moving(9.0, 9.0));
        plan.then(1.0, &PositionReference { jerk_m_s3: Vector3::y() * 6.0, ..joint });
        let later = plan.at(4_000_000);
        assert_eq!(later.position_m, Vector3::new(7.0, 8.0, -2.0));
        assert_eq!((later.acceleration_m_s2.y, later.jerk_m_s3.y), (12.0, 6.0));
        assert_eq!(plan.at(1_500_000).position_m, Vector3::new(2.0, 0.0, -2.0));
    }

    #[test]
    fn a_turn_has_a_time_of_its_own_and_any_number_of_turns() {
        let turn = MotionProfile::constant(Motion { velocity: 0.5, ..Motion::at(-3.0) });
        let plan = ReferencePlan::new(0, &moving(1.0, 0.0)).turning(1_000_000, turn);
        assert_eq!((plan.at(3_000_000).yaw_rad, plan.at(3_000_000).yaw_rate_rad_s), (-2.0, 0.5));
        let counted = plan.near_heading(3.2, 1_000_000).at(1_000_000).yaw_rad;
        assert!((counted - core::f64::consts::TAU + 3.0).abs() < 1e-12, "{counted}");
    }

    #[test]
    fn what_is_not_finite_is_found() {
        assert!(ReferencePlan::new(0, &moving(1.0, 1.0)).is_finite());
        assert!(!ReferencePlan::new(0, &moving(f64::NAN, 1.0)).is_finite());
        let turn = MotionProfile::constant(Motion::at(f64::INFINITY));
        assert!(!ReferencePlan::new(0, &moving(1.0, 1.0)).turning(0, turn).is_finite());
    }
}
