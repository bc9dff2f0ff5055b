//! One leg: straight to a place, and around its corner without stopping where the next leg allows.
//!
//! ```text
//!  in motion ─► Joining ─┐
//!                        ▼ passes the entry
//!  at rest ─► Straight ─► Turning ──► the next leg: Leaving ─► Straight ─► …
//!                   └─► arrives at rest
//! ```
//!
//! Straights and blends are planned in time. Only a leg that begins in some motion, after a pause or another mode, is joined
//! through the shaper.

use nalgebra::Vector3;
use quadrotor::{EasedLimits, Limits, PositionReference};

use super::super::situation::Situation;
use super::super::trajectory::{Piece, PieceFlight, Straight};
use super::path::{Corner, Start};

/// A corner that is being passed since a time, µs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    corner: Corner,
    start_us: u64,
    /// The limits that its leg was planned within.
    limits: EasedLimits,
}

impl Turn {
    fn flight(&self) -> PieceFlight {
        PieceFlight { piece: Piece::Blend(self.corner.blend), start_us: self.start_us }
    }

    /// Motion at its end.
    pub fn end(&self) -> PositionReference {
        self.flight().end()
    }

    /// The limits that hold now, and those that its leg was planned within.
    pub fn limits(&self, wanted: &Limits) -> EasedLimits {
        let mut limits = self.limits;
        limits.want(wanted);
        limits
    }
}

/// Part of a leg.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(clippy::large_enum_variant)] // There is one of it.
enum Phase {
    /// Around the corner before it, and what is planned behind that.
    Leaving(Turn, Option<Straight>),
    /// To the straight line, from any motion.
    Joining,
    /// Along the line.
    Straight(PieceFlight),
    /// Around the corner at its end.
    Turning(Turn),
}

/// How a leg goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(clippy::large_enum_variant)] // One of them is returned a tick.
pub enum LegProgress {
    /// It is flown.
    Flying,
    /// Its end is reached at rest.
    Arrived,
    /// Its end is passed.
    Passed(Turn),
}

/// How the vehicle is to be steered along a leg.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(clippy::large_enum_variant)] // There is one of it.
pub enum Guide {
    /// Through the shaper, to a place that is passed with a velocity.
    Goal(PositionReference),
    /// Along a piece.
    Path {
        /// The piece.
        flight: PieceFlight,
        /// The one behind it, if that is known.
        next: Option<PieceFlight>,
        /// The corners of the way after the piece, NED, m.
        after_m: [Vector3<f64>; 2],
    },
}

/// A leg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    /// Where it begins, NED, m.
    pub from_m: Vector3<f64>,
    /// Where it ends, NED, m.
    pub to_m: Vector3<f64>,
    /// Acceptance radius of its end, m.
    pub radius_m: f64,
    corner: Option<Corner>,
    /// The limits that hold, and larger ones that it began with as long as it needs them.
    limits: EasedLimits,
    phase: Phase,
}

/// The nearest that an end at rest is waited for, m, and the farthest; and how slow, m/s. The reference is waited for as the
/// nearest.
const REST_M: (f64, f64) = (0.1, 0.5);
const SLOW_M_S: f64 = 0.5;
/// A reference slower than this, m/s, rests.
const RESTS_M_S: f64 = 1e-3;
/// An entry that was passed this long ago, s, by a reference that does not move as the blend does was missed.
const MISSED_S: f64 = 0.2;

/// Whether a reference rests.
pub fn is_at_rest(reference: &PositionReference) -> bool {
    reference.velocity_m_s.norm() <= RESTS_M_S
}

/// Whether a reference is about to come to rest: that is waited for.
pub fn is_settling(reference: &PositionReference) -> bool {
    !is_at_rest(reference) && reference.velocity_m_s.norm() < SLOW_M_S
}

impl Leg {
    /// A leg that takes a turn over, and passes its corner if there is one.
    pub fn after(
        turn: Turn,
        [from_m, to_m]: [Vector3<f64>; 2],
        radius_m: f64,
        corner: Option<Corner>,
        wanted: &Limits,
    ) -> Self {
        let limits = turn.limits(wanted);
        let leg = Self { from_m, to_m, radius_m, corner, limits, phase: Phase::Joining };
        Self { phase: Phase::Leaving(turn, leg.straight_after(&turn)), ..leg }
    }

    /// A leg that begins with a reference: straight at rest, and joined from any motion.
    pub fn begin(
        situation: &Situation,
        [from_m, to_m]: [Vector3<f64>; 2],
        radius_m: f64,
        corner: Option<Corner>,
    ) -> Self {
        let limits = EasedLimits::new(situation.limits());
        let mut leg = Self { from_m, to_m, radius_m, corner, limits, phase: Phase::Joining };
        let reference = &situation.outputs.setpoint;
        if is_at_rest(reference) {
            let rest = PositionReference::goal(reference.position_m.into(), reference.yaw_rad);
            leg.phase = leg.straight(&rest, situation.time_us);
        }
        leg
    }

    /// Where a plan of its corner begins; `None` while that corner is being passed.
    pub fn start(&self, situation: &Situation) -> Option<Start> {
        let limits = situation.limits();
        match self.phase {
            Phase::Leaving(turn, _) => Some(Start::settled(&turn.end(), limits, true)),
            Phase::Joining => Some(Start::settled(&situation.outputs.setpoint, limits, false)),
            Phase::Straight(flight) => Some(Start::settled(&flight.at(situation.time_us), limits, true)),
            Phase::Turning(_) => None,
        }
    }

    /// Plans again from the present motion within other limits, with another corner. What cannot keep them is flown as planned.
    pub fn replan(&mut self, corner: Option<Corner>, situation: &Situation) {
        let limits = situation.limits();
        self.limits.want(limits);
        let other = Self { corner, ..*self };
        self.phase = match self.phase {
            Phase::Straight(flight) => {
                let now = flight.at(situation.time_us);
                let Some(straight) = other.straight_within(&now, limits) else { return };
                Phase::Straight(PieceFlight { piece: Piece::Straight(straight), start_us: situation.time_us })
            }
            Phase::Leaving(turn, _) => {
                let straight = other.straight_within(&turn.end(), limits);
                if straight.is_none() {
                    return;
                }
                Phase::Leaving(turn, straight)
            }
            unchanged => unchanged,
        };
        self.limits.release();
        self.corner = corner;
    }

    /// All of it is planned within the limits that hold.
    pub fn release_limits(&mut self) {
        self.limits.release();
    }

    /// Whether it can be flown within limits from the motion that it begins with.
    pub fn is_flyable(&self, limits: &Limits) -> bool {
        match self.phase {
            Phase::Leaving(turn, _) => self.straight_within(&turn.end(), limits).is_some(),
            _ => true,
        }
    }

    /// How the vehicle is to be steered.
    pub fn guide(&self) -> Guide {
        match self.phase {
            Phase::Leaving(turn, straight) => {
                let flight = turn.flight();
                let next = straight.map(|straight| PieceFlight {
                    piece: Piece::Straight(straight),
                    start_us: flight.end_us(),
                });
                Guide::Path { flight, next, after_m: [self.to_m; 2] }
            }
            Phase::Joining => Guide::Goal(self.joint()),
            Phase::Straight(flight) => {
                let after_m = self.corner.map_or(self.to_m, |corner| corner.after_m);
                let next = self.corner.map(|corner| PieceFlight {
                    piece: Piece::Blend(corner.blend),
                    start_us: flight.end_us(),
                });
                Guide::Path { flight, next, after_m: [self.to_m, after_m] }
            }
            Phase::Turning(turn) => {
                Guide::Path { flight: turn.flight(), next: None, after_m: [turn.corner.after_m; 2] }
            }
        }
    }

    /// The motion at the end of the straight line.
    fn joint(&self) -> PositionReference {
        let (position_m, velocity_m_s) = match &self.corner {
            Some(Corner { blend, .. }) => (blend.entry_m(), blend.velocity_in_m_s),
            None => (self.to_m, Vector3::zeros()),
        };
        PositionReference { velocity_m_s, ..PositionReference::goal(position_m.into(), 0.0) }
    }

    /// Along the line from a motion on it, within limits; `None` if it cannot end where and as it is to.
    fn straight_within(&self, from: &PositionReference, limits: &Limits) -> Option<Straight> {
        self.any_straight(from, limits).filter(|straight| !straight.leaves_its_way())
    }

    /// As [`Leg::straight_within`], and one that runs past its end as well.
    fn any_straight(&self, from: &PositionReference, limits: &Limits) -> Option<Straight> {
        let PositionReference { position_m, velocity_m_s, .. } = self.joint();
        Straight::new(from, &position_m, &velocity_m_s, limits)
    }

    /// Along the line behind a turn, as far as it is known before its end.
    fn straight_after(&self, turn: &Turn) -> Option<Straight> {
        let end = turn.end();
        self.limits.least(|limits| self.straight_within(&end, limits)).map(|(straight, _)| straight)
    }

    /// Along the line from a motion on it, within the least of its limits that do; a corner that cannot be passed after that is
    /// given up.
    fn straight(&mut self, from: &PositionReference, start_us: u64) -> Phase {
        let within = |leg: &Self| leg.limits.least(|limits| leg.straight_within(from, limits));
        let found = within(self).or_else(|| {
            self.corner = None;
            within(self)
        });
        // Behind a corner the legs count with the limits that it was planned within.
        if self.corner.is_none() && matches!(found, Some((_, true))) {
            self.limits.release();
        }
        let straight = found.map(|(straight, _)| straight);
        let straight = straight.or_else(|| self.any_straight(from, &self.limits.largest()));
        straight.map_or(Phase::Joining, |straight| {
            Phase::Straight(PieceFlight { piece: Piece::Straight(straight), start_us })
        })
    }

    /// One look: at the reference and at the vehicle.
    pub fn update(&mut self, situation: &Situation) -> LegProgress {
        let (outputs, time_us) = (situation.outputs, situation.time_us);
        let distance_m = (outputs.position_m - self.to_m).norm();
        self.phase = match self.phase {
            Phase::Leaving(turn, _) if time_us >= turn.flight().end_us() => {
                self.limits.want(situation.limits());
                self.straight(&turn.end(), turn.flight().end_us())
            }
            Phase::Joining => self.joined(&outputs.setpoint, time_us),
            Phase::Straight(flight) if time_us >= flight.end_us() => match self.corner {
                Some(corner) => {
                    Phase::Turning(Turn { corner, start_us: flight.end_us(), limits: self.limits })
                }
                None => self.phase,
            },
            unchanged => unchanged,
        };
        match self.phase {
            Phase::Turning(turn) => {
                // The middle of the turn is the nearest that the reference comes to the corner.
                let through = distance_m <= self.radius_m || time_us >= turn.flight().time_us(0.5);
                if through { LegProgress::Passed(turn) } else { LegProgress::Flying }
            }
            Phase::Joining | Phase::Straight(_) if self.corner.is_none() => {
                let near_m = self.radius_m.clamp(REST_M.0, REST_M.1);
                let led_m = (outputs.setpoint.position_m - self.to_m).norm();
                let near = distance_m < near_m && led_m < REST_M.0;
                let arrived = near && outputs.velocity_m_s.norm() < SLOW_M_S;
                if arrived { LegProgress::Arrived } else { LegProgress::Flying }
            }
            _ => LegProgress::Flying,
        }
    }

    /// A join ends where the reference passes the entry as the blend does.
    fn joined(&mut self, reference: &PositionReference, time_us: u64) -> Phase {
        let Some(corner) = self.corner else { return Phase::Joining };
        if let Some(elapsed_s) = corner.blend.elapsed_s(reference) {
            let start_us = time_us.saturating_sub((elapsed_s * 1e6) as u64);
            return Phase::Turning(Turn { corner, start_us, limits: self.limits });
        }
        let velocity_m_s = corner.blend.velocity_in_m_s;
        let past_m = (reference.position_m - corner.blend.entry_m()).dot(&velocity_m_s) / velocity_m_s.norm();
        let ahead = reference.velocity_m_s.dot(&velocity_m_s) > 0.0;
        if ahead && past_m > MISSED_S * velocity_m_s.norm() {
            self.corner = None;
        }
        Phase::Joining
    }

    /// Direction of the leg, rad from north, if it has a horizontal one.
    pub fn bearing_rad(&self) -> Option<f64> {
        bearing_rad(&self.from_m, &self.to_m)
    }
}

/// Direction of a way between two places, rad from north, if it has a horizontal one.
pub fn bearing_rad(from_m: &Vector3<f64>, to_m: &Vector3<f64>) -> Option<f64> {
    const SHORTEST_M: f64 = 1.0;
    let way = to_m - from_m;
    (way.xy().norm() > SHORTEST_M).then(|| libm::atan2(way.y, way.x))
}
