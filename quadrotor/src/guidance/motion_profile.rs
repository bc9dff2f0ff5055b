//! Motion along one axis in pieces of constant jerk.

use serde::{Deserialize, Serialize};

/// Position, velocity, acceleration and jerk at one instant, in SI units of the axis.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Motion {
    /// Position.
    pub position: f64,
    /// Velocity.
    pub velocity: f64,
    /// Acceleration.
    pub acceleration: f64,
    /// Jerk.
    pub jerk: f64,
}

impl Motion {
    /// At rest.
    pub fn at(position: f64) -> Self {
        Self { position, ..Self::default() }
    }

    /// `time_s` later, under constant jerk.
    pub fn after(&self, time_s: f64) -> Self {
        let Self { position: p, velocity: v, acceleration: a, jerk: j } = *self;
        Self {
            position: p + time_s * (v + time_s * (a / 2.0 + time_s * j / 6.0)),
            velocity: v + time_s * (a + time_s * j / 2.0),
            acceleration: a + time_s * j,
            jerk: j,
        }
    }
}

/// Most pieces that a profile can have: two to brake into the limits, seven of the jerk-limited profile,
/// and the one that goes on for ever.
const PIECES: usize = 10;

/// A motion in pieces of constant jerk; the last piece never ends.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MotionProfile {
    /// When each piece begins, s, and its motion there; only the first `count` are used.
    pieces: [(f64, Motion); PIECES],
    count: usize,
}

impl MotionProfile {
    /// One motion for ever.
    pub fn constant(motion: Motion) -> Self {
        Self { pieces: [(0.0, motion); PIECES], count: 1 }
    }

    /// Adds a piece that begins at `start_s`. Pieces beyond the tenth are not a profile's: ignored.
    pub(crate) fn push(&mut self, start_s: f64, motion: Motion) {
        if let Some(piece) = self.pieces.get_mut(self.count) {
            *piece = (start_s, motion);
            self.count += 1;
        }
    }

    /// When the last piece begins, s: from then on the velocity stays as it is.
    pub fn duration_s(&self) -> f64 {
        self.last().0
    }

    /// The motion at the beginning of the last piece.
    pub fn end(&self) -> Motion {
        self.last().1
    }

    /// The lowest velocity on the way.
    pub fn lowest_velocity(&self) -> f64 {
        let used = self.pieces.get(..self.count).unwrap_or(&self.pieces);
        let within = used.iter().zip(used.iter().skip(1)).flat_map(|((start_s, motion), (end_s, _))| {
            let duration_s = end_s - start_s;
            // Where the acceleration passes zero.
            let turn_s = -motion.acceleration / motion.jerk;
            let turns = (turn_s > 0.0 && turn_s < duration_s).then(|| motion.after(turn_s).velocity);
            [Some(motion.velocity), turns].into_iter().flatten()
        });
        within.fold(self.end().velocity, f64::min)
    }

    fn last(&self) -> &(f64, Motion) {
        self.pieces.get(..self.count).and_then(<[_]>::last).unwrap_or(&self.pieces[0])
    }

    /// The motion at `time_s` ≥ 0 after the start.
    pub fn at(&self, time_s: f64) -> Motion {
        let used = self.pieces.get(..self.count).unwrap_or(&self.pieces);
        let (start_s, motion) =
            used.iter().rev().find(|(start_s, _)| *start_s <= time_s).unwrap_or(&self.pieces[0]);
        motion.after(time_s - start_s)
    }
}
