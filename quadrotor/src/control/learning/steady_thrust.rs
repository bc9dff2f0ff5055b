//! The thrust of the last seconds, and how steady it was.

use serde::{Deserialize, Serialize};

use crate::GRAVITY_M_S2;

/// Averages of the thrust per mass, m/s².
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct SteadyThrust {
    mean_m_s2: f64,
    deviation_m_s2: f64,
}

impl SteadyThrust {
    /// That of hover.
    pub(crate) fn new() -> Self {
        Self { mean_m_s2: GRAVITY_M_S2, deviation_m_s2: 0.0 }
    }

    /// The average.
    pub(crate) fn mean_m_s2(&self) -> f64 {
        self.mean_m_s2
    }

    /// How far the thrust mostly is from that.
    pub(crate) fn deviation_m_s2(&self) -> f64 {
        self.deviation_m_s2
    }

    /// Takes a thrust in that counts with a share.
    pub(crate) fn see(&mut self, thrust_m_s2: f64, share: f64) {
        let deviation_m_s2 = libm::fabs(thrust_m_s2 - self.mean_m_s2);
        self.deviation_m_s2 += (deviation_m_s2 - self.deviation_m_s2) * share;
        self.mean_m_s2 += (thrust_m_s2 - self.mean_m_s2) * share;
    }

    /// Whether a flight can have had it: saved states may come from anywhere.
    pub(crate) fn is_possible(&self) -> bool {
        [self.mean_m_s2, self.deviation_m_s2].iter().all(|thrust| thrust.is_finite() && *thrust >= 0.0)
    }
}
