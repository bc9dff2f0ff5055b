//! From the reference that was given to the set-point that the cascade tracks.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::attitude::wrapped;
use crate::setpoint::Setpoint;
#[cfg(feature = "shaper")]
use crate::shaper::Shaper;
use crate::{Configuration, Limits, PositionReference};

/// State of the reference: shaped towards a goal, or passed on as it comes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[allow(clippy::large_enum_variant)] // One of them lives in each simulation; boxing would allocate.
pub enum Guidance {
    /// Jerk-limited.
    #[cfg(feature = "shaper")]
    Shaped(Shaper),
    /// Position, velocity and acceleration as given; the heading within its rate limit.
    Direct(Direct),
}

/// State of a reference that is passed on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Direct {
    latest: Setpoint,
    yaw_time_us: u64,
}

/// Heading ψ, rad, and its rate, rad/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heading {
    /// ψ, rad.
    pub yaw_rad: f64,
    /// Its rate, rad/s.
    pub yaw_rate_rad_s: f64,
}

#[cfg_attr(not(feature = "shaper"), allow(unused_variables, irrefutable_let_patterns))]
impl Guidance {
    /// A reference that rests in one place.
    pub fn new(configuration: &Configuration, position_m: &Vector3<f64>, yaw_rad: f64, time_us: u64) -> Self {
        #[cfg(feature = "shaper")]
        if configuration.reference.shaping {
            return Self::Shaped(Shaper::at_rest(position_m, yaw_rad, &configuration.limits, time_us));
        }
        Self::Direct(Direct { latest: Setpoint::hold(position_m, yaw_rad), yaw_time_us: time_us })
    }

    /// A sample of the position and altitude controllers' reference, `period_us` after the last.
    pub fn sample(&mut self, reference: &PositionReference, limits: &Limits, time_us: u64, period_us: u64) {
        match self {
            #[cfg(feature = "shaper")]
            Self::Shaped(shaper) => shaper.update(reference, limits, time_us),
            Self::Direct(direct) => direct.sample(reference, limits, period_us),
        }
    }

    /// A sample of the attitude controller's heading reference.
    pub fn sample_heading(
        &mut self,
        reference: &PositionReference,
        limits: &Limits,
        time_us: u64,
    ) -> Heading {
        if let Self::Direct(direct) = self {
            direct.sample_yaw(reference, limits, time_us);
        }
        let PositionReference { yaw_rad, yaw_rate_rad_s, .. } = self.setpoint(time_us).reference;
        Heading { yaw_rad, yaw_rate_rad_s }
    }

    /// The set-point at `time_us`.
    pub fn setpoint(&self, time_us: u64) -> Setpoint {
        match self {
            #[cfg(feature = "shaper")]
            Self::Shaped(shaper) => shaper.setpoint(time_us),
            Self::Direct(direct) => direct.latest,
        }
    }
}

impl Direct {
    fn sample(&mut self, reference: &PositionReference, limits: &Limits, period_us: u64) {
        // The jerk of a trajectory that is given by its acceleration; a jump of it is not motion.
        let period_s = period_us as f64 * 1e-6;
        let jerk = (reference.acceleration_m_s2 - self.latest.reference.acceleration_m_s2) / period_s;
        let smooth =
            jerk.xy().norm() <= limits.jerk_horizontal_m_s3 && jerk.z.abs() <= limits.jerk_vertical_m_s3;
        let held = &self.latest.reference;
        self.latest = Setpoint {
            reference: PositionReference {
                yaw_rad: held.yaw_rad,
                yaw_rate_rad_s: held.yaw_rate_rad_s,
                ..*reference
            },
            jerk_m_s3: if smooth { jerk } else { Vector3::zeros() },
        };
    }

    fn sample_yaw(&mut self, reference: &PositionReference, limits: &Limits, time_us: u64) {
        let elapsed_s = time_us.saturating_sub(self.yaw_time_us) as f64 * 1e-6;
        let most = limits.yaw_rate_rad_s * elapsed_s;
        let held = &mut self.latest.reference;
        held.yaw_rad += wrapped(reference.yaw_rad - held.yaw_rad).clamp(-most, most);
        held.yaw_rate_rad_s = reference.yaw_rate_rad_s;
        self.yaw_time_us = time_us;
    }
}
