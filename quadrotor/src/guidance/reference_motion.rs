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
    /// Acceleration that the thrust must make: with drag.
    pub thrust: SVector<f64, AXES>,
    /// Its derivative.
    pub jerk: SVector<f64, AXES>,
    /// The derivative of that.
    pub snap: SVector<f64, AXES>,
    /// Time since the previous sample, s; 0 before the first one.
    pub interval_s: f64,
}

/// Nothing has been tracked yet: at rest.
impl<const AXES: usize> Default for ReferenceMotion<AXES> {
    fn default() -> Self {
        let zero: SVector<f64, AXES> = SVector::zeros();
        Self {
            position: zero,
            velocity: zero,
            acceleration: zero,
            thrust: zero,
            jerk: zero,
            snap: zero,
            interval_s: 0.0,
        }
    }
}

impl<const AXES: usize> ReferenceMotion<AXES> {
    /// Whether it stays where it is.
    pub fn is_at_rest(&self) -> bool {
        let zero: SVector<f64, AXES> = SVector::zeros();
        [self.velocity, self.acceleration, self.thrust, self.jerk, self.snap].iter().all(|part| *part == zero)
    }

    /// Increments \[Δposition, Δvelocity, Δacceleration, Δjerk, Δsnap\] of each axis since the previous sample. Those of position and
    /// velocity as far as the derivatives explain them: a jump of the position is not motion, and a set-point at rest has none.
    ///
    /// Hermite's rule, exact for constant jerk:
    /// Δp = T (v + v⁻)/2 − T² (a − a⁻)/12,  Δv = T (a + a⁻)/2
    ///
    /// At the first sample a controller takes the vehicle for one that was at rest there. The reference was so, too, and its whole
    /// velocity is an increment: a vehicle that moves with it has nothing to explain.
    pub fn increments_since(&self, previous: &Self) -> [[f64; 5]; AXES] {
        let t = self.interval_s;
        core::array::from_fn(|axis| {
            if previous.interval_s == 0.0 {
                return [0.0, self.velocity[axis], self.thrust[axis], self.jerk[axis], self.snap[axis]];
            }
            let (v, v_before) = (self.velocity[axis], previous.velocity[axis]);
            let (a, a_before) = (self.acceleration[axis], previous.acceleration[axis]);
            [
                t * (v + v_before) / 2.0 - t * t * (a - a_before) / 12.0,
                t * (a + a_before) / 2.0,
                self.thrust[axis] - previous.thrust[axis],
                self.jerk[axis] - previous.jerk[axis],
                self.snap[axis] - previous.snap[axis],
            ]
        })
    }

    /// By how much jerk and snap have jumped since the previous sample, as far as the snap in between does not explain it.
    pub(crate) fn jumps_since(&self, previous: &Self) -> [SVector<f64, AXES>; 2] {
        let explained = (self.snap + previous.snap) * (self.interval_s / 2.0);
        [self.jerk - previous.jerk - explained, self.snap - previous.snap]
    }
}
