//! The motion of a reference between two samples.

use nalgebra::SVector;
use serde::{Deserialize, Serialize};

/// Position and its derivatives on some axes, SI.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReferenceMotion<const AXES: usize> {
    /// Position.
    pub position: SVector<f64, AXES>,
    /// Velocity.
    pub velocity: SVector<f64, AXES>,
    /// Acceleration.
    pub acceleration: SVector<f64, AXES>,
    /// Its derivative.
    pub jerk: SVector<f64, AXES>,
    /// Acceleration that the thrust must make: with drag.
    pub thrust: SVector<f64, AXES>,
    /// Its derivative.
    pub thrust_jerk: SVector<f64, AXES>,
    /// The derivative of that.
    pub thrust_snap: SVector<f64, AXES>,
    /// Time since the previous sample, s; 0 before the first one.
    pub interval_s: f64,
    /// Whether limits bend it: it jumps in its jerk where they begin to hold it, and where they end.
    pub is_bent: bool,
    /// Whether so much of it is left out that the rest leaves room within the limits.
    pub is_narrow: bool,
}

/// Nothing has been tracked yet: at rest.
impl<const AXES: usize> Default for ReferenceMotion<AXES> {
    fn default() -> Self {
        let zero: SVector<f64, AXES> = SVector::zeros();
        Self {
            position: zero,
            velocity: zero,
            acceleration: zero,
            jerk: zero,
            thrust: zero,
            thrust_jerk: zero,
            thrust_snap: zero,
            interval_s: 0.0,
            is_bent: false,
            is_narrow: false,
        }
    }
}

impl<const AXES: usize> ReferenceMotion<AXES> {
    /// Whether it stays where it is.
    pub fn is_at_rest(&self) -> bool {
        let zero: SVector<f64, AXES> = SVector::zeros();
        let derivatives =
            [self.velocity, self.acceleration, self.jerk, self.thrust, self.thrust_jerk, self.thrust_snap];
        derivatives.iter().all(|part| *part == zero)
    }

    /// Increments of each axis since the previous sample: those of position and velocity, and of the thrust and its two derivatives.
    /// Those of position and velocity as far as the derivatives explain them: a jump of the position is not motion, and a set-point at
    /// rest has none.
    ///
    /// Hermite's rule, exact for a jerk that changes evenly:
    /// Δp = T (v + v⁻)/2 − T² (a − a⁻)/12,  Δv = T (a + a⁻)/2 − T² (j − j⁻)/12
    ///
    /// At the first sample a controller that goes by increments takes the vehicle for one that was at rest there. The reference was so,
    /// too, and its whole velocity is an increment: a vehicle that moves with it has nothing to explain.
    pub fn increments_since(&self, previous: &Self) -> [[f64; 5]; AXES] {
        let t = self.interval_s;
        core::array::from_fn(|axis| {
            if previous.interval_s == 0.0 {
                let [thrust, jerk, snap] =
                    [self.thrust, self.thrust_jerk, self.thrust_snap].map(|part| part[axis]);
                return [0.0, self.velocity[axis], thrust, jerk, snap];
            }
            let hermite = |rate: &SVector<f64, AXES>, before: &SVector<f64, AXES>, change: f64| {
                t * (rate[axis] + before[axis]) / 2.0 - t * t * change / 12.0
            };
            let change = |now: &SVector<f64, AXES>, before: &SVector<f64, AXES>| now[axis] - before[axis];
            [
                hermite(
                    &self.velocity,
                    &previous.velocity,
                    change(&self.acceleration, &previous.acceleration),
                ),
                hermite(&self.acceleration, &previous.acceleration, change(&self.jerk, &previous.jerk)),
                change(&self.thrust, &previous.thrust),
                change(&self.thrust_jerk, &previous.thrust_jerk),
                change(&self.thrust_snap, &previous.thrust_snap),
            ]
        })
    }

    /// By how much the thrust's jerk and snap have jumped since the previous sample, as far as the snap in between does not explain it.
    pub(crate) fn jumps_since(&self, previous: &Self) -> [SVector<f64, AXES>; 2] {
        let explained = (self.thrust_snap + previous.thrust_snap) * (self.interval_s / 2.0);
        [self.thrust_jerk - previous.thrust_jerk - explained, self.thrust_snap - previous.thrust_snap]
    }
}
