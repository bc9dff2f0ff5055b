//! A piece of a way that is being flown.

use nalgebra::Vector3;
use quadrotor::{PositionReference, ReferencePlan};

use super::blend::Blend;
use super::straight::Straight;

/// A piece of a way.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(clippy::large_enum_variant)] // There are few of them.
pub enum Piece {
    /// Along a line.
    Straight(Straight),
    /// Around a corner.
    Blend(Blend),
}

/// A piece and when it began.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PieceFlight {
    /// The piece.
    pub piece: Piece,
    /// Time of its beginning, µs.
    pub start_us: u64,
}

impl PieceFlight {
    /// From its beginning to its end, s.
    fn duration_s(&self) -> f64 {
        match &self.piece {
            Piece::Straight(straight) => straight.duration_s(),
            Piece::Blend(blend) => blend.duration_s,
        }
    }

    /// When a share of its time is over, µs.
    pub fn time_us(&self, share: f64) -> u64 {
        self.start_us.saturating_add((share * self.duration_s() * 1e6) as u64)
    }

    /// When it ends, µs.
    pub fn end_us(&self) -> u64 {
        self.time_us(1.0)
    }

    /// Motion at a time, µs; after its end it goes on evenly. The heading is zero.
    pub fn at(&self, time_us: u64) -> PositionReference {
        let time_s = time_us.saturating_sub(self.start_us) as f64 / 1e6;
        match &self.piece {
            Piece::Straight(straight) => straight.at(time_s),
            Piece::Blend(blend) => blend.at(time_s),
        }
    }

    /// The way along the piece, and along the next one if it is known, as the control loop can look ahead on it. After its end it
    /// goes on evenly.
    pub fn plan(&self, next: Option<&Self>) -> ReferencePlan {
        let mut plan = ReferencePlan::new(self.start_us, &self.at(self.start_us));
        for flight in [Some(self), next].into_iter().flatten() {
            let after_s = flight.start_us.saturating_sub(self.start_us) as f64 / 1e6;
            let mut add = |(start_s, motion): (f64, PositionReference)| plan.then(after_s + start_s, &motion);
            match &flight.piece {
                Piece::Straight(straight) => straight.pieces().for_each(&mut add),
                Piece::Blend(blend) => blend.pieces().for_each(&mut add),
            }
        }
        plan
    }

    /// Places on the way from a time, µs, to its end, NED, m: the way between them is straight, or nearly so.
    pub fn places_m(&self, time_us: u64) -> impl Iterator<Item = Vector3<f64>> {
        const PARTS: u32 = 8;
        let count = match &self.piece {
            Piece::Straight(_) => 1,
            Piece::Blend(_) => PARTS,
        };
        let (flight, left_us) = (*self, self.end_us().saturating_sub(time_us));
        (1..=count).map(move |part| match part {
            _ if part == count => flight.end().position_m,
            _ => flight.at(time_us + left_us * u64::from(part) / u64::from(count)).position_m,
        })
    }

    /// Motion at its end. The heading is zero.
    pub fn end(&self) -> PositionReference {
        match &self.piece {
            Piece::Straight(straight) => straight.at(straight.duration_s()),
            Piece::Blend(blend) => blend.at(blend.duration_s),
        }
    }
}
