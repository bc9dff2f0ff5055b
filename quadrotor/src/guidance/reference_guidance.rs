//! From the reference that was given to the set-point that the cascade tracks.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::attitude::wrapped;
use crate::guidance::eased_limits::EasedLimits;
use crate::guidance::heading::Heading;
use crate::guidance::setpoint::Setpoint;
#[cfg(feature = "shaper")]
use crate::guidance::shaper::Shaper;
use crate::{Limits, PositionReference};

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
    latest: PositionReference,
    /// Jerk of the trajectory, from its last two accelerations, NED, m/s³.
    jerk_m_s3: Vector3<f64>,
    time_us: u64,
    yaw_time_us: u64,
}

#[cfg_attr(not(feature = "shaper"), allow(unused_variables, irrefutable_let_patterns))]
impl Guidance {
    /// A reference that rests in one place.
    pub fn new(
        limits: &Limits,
        shaping: bool,
        position_m: &Vector3<f64>,
        yaw_rad: f64,
        time_us: u64,
    ) -> Self {
        #[cfg(feature = "shaper")]
        if shaping {
            return Self::Shaped(Shaper::at_rest(position_m, yaw_rad, limits, time_us));
        }
        Self::Direct(Direct {
            latest: PositionReference::goal((*position_m).into(), yaw_rad),
            jerk_m_s3: Vector3::zeros(),
            time_us,
            yaw_time_us: time_us,
        })
    }

    /// Whether it is shaped.
    pub fn is_shaped(&self) -> bool {
        !matches!(self, Self::Direct(_))
    }

    /// A reference, shaped or not, that goes on from where this one is.
    pub fn switched(&self, limits: &EasedLimits, shaping: bool, time_us: u64) -> Self {
        let now = self.reference(time_us);
        #[cfg(feature = "shaper")]
        if shaping {
            return Self::Shaped(Shaper::moving(&now, limits, time_us));
        }
        Self::Direct(Direct { latest: now, jerk_m_s3: Vector3::zeros(), time_us, yaw_time_us: time_us })
    }

    /// A sample of the reference of the position and altitude controllers.
    pub fn sample(&mut self, reference: &PositionReference, limits: &Limits, time_us: u64) {
        match self {
            #[cfg(feature = "shaper")]
            Self::Shaped(shaper) => shaper.update(reference, limits, time_us),
            Self::Direct(direct) => direct.sample(reference, limits, time_us),
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
        Heading::of(&self.reference(time_us))
    }

    /// Whether the way that is tracked at `time_us` is within limits: a plan keeps them, and its acceleration fits them. A
    /// reference that is passed on is another's plan, which may brake as before until it rests, unless `moving` ones fit, too.
    pub fn fits(&self, limits: &Limits, moving: bool, time_us: u64) -> bool {
        /// What rounding makes of an acceleration at its limit.
        const ROUNDING: f64 = 1.0 + 1e-6;
        /// A reference slower than this, m/s, rests.
        const RESTS_M_S: f64 = 0.1;
        let now = self.reference(time_us);
        let acceleration = now.acceleration_m_s2;
        let small = acceleration.xy().norm() <= ROUNDING * limits.acceleration_horizontal_m_s2
            && acceleration.z.abs() <= ROUNDING * limits.acceleration_vertical_m_s2;
        match self {
            #[cfg(feature = "shaper")]
            Self::Shaped(shaper) => small && shaper.keeps_limits(),
            Self::Direct(_) => small && (moving || now.velocity_m_s.norm() <= RESTS_M_S),
        }
    }

    /// What is tracked at `time_us`.
    pub fn reference(&self, time_us: u64) -> PositionReference {
        match self {
            #[cfg(feature = "shaper")]
            Self::Shaped(shaper) => shaper.reference(time_us),
            Self::Direct(direct) => direct.reference(time_us),
        }
    }

    /// What is tracked at `time_us`, with its jerk.
    pub fn setpoint(&self, time_us: u64) -> Setpoint {
        /// Time over which a jerk is found, µs.
        const STEP_US: u64 = 1000;
        let jerk_m_s3 = match self {
            #[cfg(feature = "shaper")]
            Self::Shaped(shaper) => {
                (shaper.reference(time_us + STEP_US).acceleration_m_s2
                    - shaper.reference(time_us).acceleration_m_s2)
                    / (STEP_US as f64 / 1e6)
            }
            Self::Direct(direct) => direct.jerk_m_s3,
        };
        Setpoint { reference: self.reference(time_us), jerk_m_s3 }
    }
}

/// Multiple of the jerk limits beyond which a change of acceleration counts as a jump, not as motion.
const JUMP: f64 = 10.0;

impl Direct {
    /// The latest reference, moved on by its derivatives since it was sampled.
    fn reference(&self, time_us: u64) -> PositionReference {
        let t = time_us.saturating_sub(self.time_us) as f64 / 1e6;
        let yaw_t = time_us.saturating_sub(self.yaw_time_us) as f64 / 1e6;
        let PositionReference { position_m: p, velocity_m_s: v, acceleration_m_s2: a, .. } = self.latest;
        PositionReference {
            position_m: p + (v + (a / 2.0 + self.jerk_m_s3 * (t / 6.0)) * t) * t,
            velocity_m_s: v + (a + self.jerk_m_s3 * (t / 2.0)) * t,
            acceleration_m_s2: a + self.jerk_m_s3 * t,
            yaw_rad: self.latest.yaw_rad + self.latest.yaw_rate_rad_s * yaw_t,
            yaw_rate_rad_s: self.latest.yaw_rate_rad_s,
        }
    }

    fn sample(&mut self, reference: &PositionReference, limits: &Limits, time_us: u64) {
        let change = reference.acceleration_m_s2 - self.latest.acceleration_m_s2;
        let elapsed_s = time_us.saturating_sub(self.time_us) as f64 / 1e6;
        // A reference that has just been taken over has no motion yet.
        if elapsed_s > 0.0 {
            let jerk = change / elapsed_s;
            // A jump of the acceleration is not motion.
            let smooth = jerk.xy().norm() <= JUMP * limits.jerk_horizontal_m_s3
                && jerk.z.abs() <= JUMP * limits.jerk_vertical_m_s3;
            self.jerk_m_s3 = if smooth { jerk } else { Vector3::zeros() };
        }
        let held = self.latest;
        self.latest =
            PositionReference { yaw_rad: held.yaw_rad, yaw_rate_rad_s: held.yaw_rate_rad_s, ..*reference };
        self.time_us = time_us;
    }

    fn sample_yaw(&mut self, reference: &PositionReference, limits: &Limits, time_us: u64) {
        let elapsed_s = time_us.saturating_sub(self.yaw_time_us) as f64 / 1e6;
        let most = limits.yaw_rate_rad_s * elapsed_s;
        let held = &mut self.latest;
        let turned = wrapped(reference.yaw_rad - held.yaw_rad).clamp(-most, most);
        held.yaw_rad += turned;
        // A heading that moves has a rate, also when none was given.
        let given = reference.yaw_rate_rad_s;
        let rate = if given == 0.0 && elapsed_s > 0.0 { turned / elapsed_s } else { given };
        held.yaw_rate_rad_s = rate.clamp(-limits.yaw_rate_rad_s, limits.yaw_rate_rad_s);
        self.yaw_time_us = time_us;
    }
}
