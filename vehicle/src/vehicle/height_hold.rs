//! The thrust that follows a climb rate, for modes in which the pilot leans the vehicle.

use libm::cos;
use quadrotor::GRAVITY_M_S2;

use super::situation::Situation;

/// How hard errors of height and climb rate are corrected, and their sum, 1/s², 1/s and 1/s³.
const HEIGHT_GAIN: f64 = 4.0;
const RATE_GAIN: f64 = 4.0;
const SUM_GAIN: f64 = 1.0;
/// The reference leads the vehicle by no more than this, m.
const LEAD_M: f64 = 1.0;
/// The sum corrects no more than this, m/s².
const MOST_SUM_M_S2: f64 = 3.0;
/// The thrust stays above this share of the weight in the air: the torques need it.
const LEAST_OF_WEIGHT: f64 = 0.2;
/// Leaning further than this, the thrust does not grow any more.
const LEAST_UPRIGHT: f64 = 0.5;

/// A reference of height, and what its errors have added up to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeightHold {
    /// Down, m.
    z_m: f64,
    /// Up, m/s.
    climb_m_s: f64,
    sum_m_s2: f64,
}

impl HeightHold {
    /// Goes on from the present motion.
    pub fn begin(situation: &Situation) -> Self {
        let outputs = situation.outputs;
        Self { z_m: outputs.position_m.z, climb_m_s: -outputs.velocity_m_s.z, sum_m_s2: 0.0 }
    }

    /// Share of the largest thrust that climbs at this rate, m/s, for `dt_s`.
    pub fn thrust(&mut self, situation: &Situation, climb_m_s: f64, dt_s: f64) -> f64 {
        let outputs = situation.outputs;
        let limits = situation.limits();
        let wanted = climb_m_s.clamp(-limits.speed_down_m_s, limits.speed_up_m_s);
        let fastest = situation.conduct.sticks.climb_m_s2 * dt_s;
        let change = (wanted - self.climb_m_s).clamp(-fastest, fastest);
        self.climb_m_s += change;
        let z_m = outputs.position_m.z;
        self.z_m = (self.z_m - self.climb_m_s * dt_s).clamp(z_m - LEAD_M, z_m + LEAD_M);
        let (height_error, rate_error) = (z_m - self.z_m, self.climb_m_s + outputs.velocity_m_s.z);
        self.sum_m_s2 = (self.sum_m_s2 + SUM_GAIN * height_error * dt_s).clamp(-MOST_SUM_M_S2, MOST_SUM_M_S2);
        let up_m_s2 = change / dt_s + HEIGHT_GAIN * height_error + RATE_GAIN * rate_error + self.sum_m_s2;
        let upright = cos(outputs.attitude_rad.x) * cos(outputs.attitude_rad.y);
        let airframe = &situation.configuration.airframe;
        let of_weight = ((GRAVITY_M_S2 + up_m_s2) / GRAVITY_M_S2).max(LEAST_OF_WEIGHT);
        (airframe.hover_thrust_share() * of_weight / upright.max(LEAST_UPRIGHT)).min(1.0)
    }
}
