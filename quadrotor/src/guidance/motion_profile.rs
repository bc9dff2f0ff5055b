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

/// A product takes less time than a division.
const SIXTH: f64 = 1.0 / 6.0;

impl Motion {
    /// Whether it stays where it is, for ever.
    pub fn rests(&self) -> bool {
        self.velocity == 0.0 && self.acceleration == 0.0 && self.jerk == 0.0
    }

    /// At rest.
    pub fn at(position: f64) -> Self {
        Self { position, ..Self::default() }
    }

    /// `time_s` later, under constant jerk.
    pub fn after(&self, time_s: f64) -> Self {
        let Self { position: p, velocity: v, acceleration: a, jerk: j } = *self;
        Self {
            position: p + time_s * (v + time_s * (a / 2.0 + time_s * j * SIXTH)),
            velocity: v + time_s * (a + time_s * j / 2.0),
            acceleration: a + time_s * j,
            jerk: j,
        }
    }
}

impl Motion {
    /// When the velocity or the acceleration passes zero under constant jerk, s; negative before now.
    fn turns_s(&self) -> [Option<f64>; 3] {
        let Self { velocity: v, acceleration: a, jerk: j, .. } = *self;
        if j == 0.0 {
            return [(a != 0.0).then(|| -v / a), None, None];
        }
        let discriminant = a * a - 2.0 * j * v;
        let root = (discriminant >= 0.0).then(|| libm::sqrt(discriminant));
        [Some(-a / j), root.map(|root| (-a + root) / j), root.map(|root| (-a - root) / j)]
            .map(|turn_s| turn_s.filter(|turn_s| turn_s.is_finite()))
    }
}

/// Ranges of a motion along one axis, each from the lowest to the highest value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionExtremes {
    /// Of the position.
    pub position: [f64; 2],
    /// Of the velocity.
    pub velocity: [f64; 2],
}

impl MotionExtremes {
    fn of(motion: &Motion) -> Self {
        Self { position: [motion.position; 2], velocity: [motion.velocity; 2] }
    }

    fn widen(&mut self, motion: &Motion) {
        let widen = |[low, high]: [f64; 2], value: f64| [low.min(value), high.max(value)];
        self.position = widen(self.position, motion.position);
        self.velocity = widen(self.velocity, motion.velocity);
    }

    /// How far the position leaves the way between two places, on either side.
    pub fn beyond(&self, from: f64, to: f64) -> f64 {
        let [low, high] = self.position;
        (from.min(to) - low).max(high - from.max(to)).max(0.0)
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
    pub fn push(&mut self, start_s: f64, motion: Motion) {
        if let Some(piece) = self.pieces.get_mut(self.count) {
            *piece = (start_s, motion);
            self.count += 1;
        }
    }

    /// The same motion elsewhere.
    pub(crate) fn moved(mut self, by: f64) -> Self {
        for (_, motion) in &mut self.pieces {
            motion.position += by;
        }
        self
    }

    /// When the jerk jumps after a piece, s, and by how much.
    #[cfg(feature = "shaper")]
    pub(crate) fn jumps(&self, after: usize) -> impl Iterator<Item = (f64, f64)> {
        let pairs = self.pieces().windows(2).skip(after);
        pairs.filter_map(|pair| match pair {
            [(_, before), (start_s, next)] => Some((*start_s, next.jerk - before.jerk)),
            _ => None,
        })
    }

    /// When each piece begins, s, and its motion there.
    pub fn pieces(&self) -> &[(f64, Motion)] {
        self.pieces.get(..self.count).unwrap_or(&self.pieces)
    }

    pub(crate) fn is_finite(&self) -> bool {
        self.pieces().iter().all(|(start_s, motion)| {
            let Motion { position, velocity, acceleration, jerk } = *motion;
            [*start_s, position, velocity, acceleration, jerk].iter().all(|value| value.is_finite())
        })
    }

    /// When the last piece begins, s: from then on the velocity stays as it is.
    pub fn duration_s(&self) -> f64 {
        self.last().0
    }

    /// The motion at the beginning of the last piece.
    pub fn end(&self) -> Motion {
        self.last().1
    }

    /// The ranges of position and velocity from `time_s` on until the last piece begins.
    pub fn extremes_from(&self, time_s: f64) -> MotionExtremes {
        let mut extremes = MotionExtremes::of(&self.at(time_s));
        let used = self.pieces();
        for ((start_s, motion), (end_s, end)) in used.iter().zip(used.iter().skip(1)) {
            if *end_s <= time_s {
                continue;
            }
            extremes.widen(end);
            for turn_s in motion.turns_s().into_iter().flatten() {
                if turn_s > (time_s - start_s).max(0.0) && turn_s < end_s - start_s {
                    extremes.widen(&motion.after(turn_s));
                }
            }
        }
        extremes
    }

    fn last(&self) -> &(f64, Motion) {
        self.pieces().last().unwrap_or(&self.pieces[0])
    }

    /// The motion at `time_s` ≥ 0 after the start.
    pub fn at(&self, time_s: f64) -> Motion {
        let (start_s, motion) =
            self.pieces().iter().rev().find(|(start_s, _)| *start_s <= time_s).unwrap_or(&self.pieces[0]);
        motion.after(time_s - start_s)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{Motion, MotionProfile};

    /// Pieces of constant jerk that continue one another, with their durations, s.
    fn profile(from: Motion, pieces: &[(f64, f64)]) -> MotionProfile {
        let start = |motion: Motion, jerk: f64| Motion { jerk, ..motion };
        let mut now = start(from, pieces[0].1);
        let (mut profile, mut time_s) = (MotionProfile::constant(now), 0.0);
        for (index, (duration_s, _)) in pieces.iter().enumerate() {
            time_s += duration_s;
            now = start(now.after(*duration_s), pieces.get(index + 1).map_or(0.0, |(_, jerk)| *jerk));
            profile.push(time_s, now);
        }
        profile
    }

    proptest! {
        /// Under constant jerk Simpson's rule is exact for velocity and position.
        #[test]
        fn a_motion_is_the_integral_of_its_jerk(
            p in -10.0..10.0, v in -5.0..5.0, a in -3.0..3.0, j in -4.0..4.0, time_s in 0.0..5.0,
        ) {
            let from = Motion { position: p, velocity: v, acceleration: a, jerk: j };
            let (half, whole) = (from.after(time_s / 2.0), from.after(time_s));
            let simpson = |of: fn(&Motion) -> f64| time_s / 6.0 * (of(&from) + 4.0 * of(&half) + of(&whole));
            prop_assert!((whole.acceleration - a - simpson(|motion| motion.jerk)).abs() < 1e-10);
            prop_assert!((whole.velocity - v - simpson(|motion| motion.acceleration)).abs() < 1e-10);
            prop_assert!((whole.position - p - simpson(|motion| motion.velocity)).abs() < 1e-10);
        }

        /// A fine grid over a profile finds the same ranges, and nothing outside them.
        #[test]
        fn extremes_are_those_of_a_grid(
            v in -5.0..5.0, a in -3.0..3.0,
            pieces in prop::collection::vec((0.05..2.0, prop_oneof![Just(0.0), -4.0..4.0]), 1..9), share in 0.0..1.0,
        ) {
            let profile = profile(Motion { velocity: v, acceleration: a, ..Motion::at(1.0) }, &pieces);
            let end_s: f64 = pieces.iter().map(|(duration_s, _)| duration_s).sum();
            prop_assert!((profile.duration_s() - end_s).abs() < 1e-12);
            prop_assert!((profile.end().position - profile.at(end_s).position).abs() < 1e-9);
            let from_s = share * end_s;
            let extremes = profile.extremes_from(from_s);
            let (mut position, mut velocity) = ([f64::INFINITY, f64::NEG_INFINITY], [f64::INFINITY, f64::NEG_INFINITY]);
            for step in 0..=20_000 {
                let now = profile.at(from_s + (end_s - from_s) * f64::from(step) / 20_000.0);
                position = [position[0].min(now.position), position[1].max(now.position)];
                velocity = [velocity[0].min(now.velocity), velocity[1].max(now.velocity)];
            }
            for (found, sampled) in [(extremes.position, position), (extremes.velocity, velocity)] {
                prop_assert!(found[0] <= sampled[0] + 1e-9 && found[1] >= sampled[1] - 1e-9, "{found:?} {sampled:?}");
                // Between two points of the grid a parabola rises by less than its curvature allows.
                prop_assert!(found[0] > sampled[0] - 1e-3 && found[1] < sampled[1] + 1e-3, "{found:?} {sampled:?}");
            }
            let [low, high] = extremes.position;
            prop_assert_eq!(extremes.beyond(low, high), 0.0);
            prop_assert!((extremes.beyond(low + 0.25, high + 1.0) - 0.25).abs() < 1e-12);
            prop_assert!((extremes.beyond(low - 1.0, high - 0.5) - 0.5).abs() < 1e-12);
        }
    }

    /// Before its start a profile is its first piece; moved, it keeps all but its position.
    #[test]
    fn a_moved_profile_is_the_same_elsewhere() {
        let profile = profile(Motion { velocity: 1.0, ..Motion::at(2.0) }, &[(1.0, 3.0), (0.5, -2.0)]);
        let moved = profile.moved(-7.0);
        for time_s in [0.0, 0.4, 1.0, 1.2, 1.5, 9.0] {
            let (here, there) = (profile.at(time_s), moved.at(time_s));
            assert!((there.position - here.position + 7.0).abs() < 1e-12);
            assert_eq!(Motion { position: here.position, ..there }, here);
        }
    }
}
