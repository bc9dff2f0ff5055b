//! Velocities of a trajectory whose acceleration nobody gives.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::guidance::derivative_estimator::{DerivativeEstimator, Derivatives, Sample};
use crate::{GRAVITY_M_S2, Limits};

/// Multiple of the limits of acceleration beyond which a change of the velocity is a jump, not motion.
const JUMP: f64 = 3.0;
/// What is slower, m/s², may be the motion of somebody who does not know the limits.
const FASTEST_M_S2: f64 = 4.0 * GRAVITY_M_S2;

/// Finds acceleration and jerk of a trajectory from its velocities, which somebody sets every so often. A velocity that is constant or
/// jumps has none.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StreamedVelocity(DerivativeEstimator<3>);

impl Default for StreamedVelocity {
    fn default() -> Self {
        Self(DerivativeEstimator::of_rate())
    }
}

impl StreamedVelocity {
    /// The velocity at `time_us`, m/s.
    pub fn observe(&mut self, velocity_m_s: &Vector3<f64>, limits: &Limits, time_us: u64) {
        self.look(velocity_m_s, limits, time_us);
    }

    /// The same, and what is found.
    pub(crate) fn look(&mut self, velocity_m_s: &Vector3<f64>, limits: &Limits, time_us: u64) -> Sample {
        let strongest = limits.acceleration_horizontal_m_s2.max(limits.acceleration_vertical_m_s2);
        self.0.observe(velocity_m_s, FASTEST_M_S2.max(JUMP * strongest), time_us)
    }

    /// Acceleration, m/s², and jerk, m/s³, at `time_us`.
    pub fn at(&self, time_us: u64) -> Derivatives<3> {
        self.0.at(time_us)
    }

    /// The estimator of its derivatives.
    pub(crate) fn estimator(&self) -> &DerivativeEstimator<3> {
        &self.0
    }

    /// How many samples of its motion are known.
    pub(crate) fn samples(&self) -> usize {
        self.0.samples()
    }

    /// Makes it a constant again.
    pub(crate) fn forget(&mut self) {
        self.0.forget();
    }
}
