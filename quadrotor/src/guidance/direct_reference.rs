//! A reference that is passed on as it comes.

use nalgebra::{Vector1, Vector3};
use serde::{Deserialize, Serialize};

use crate::attitude::wrapped;
use crate::guidance::derivative_estimator::{DerivativeEstimator, Derivatives};
use crate::guidance::heading::Heading;
use crate::{GRAVITY_M_S2, Limits, PositionReference};

/// Multiple of the limits of jerk and of yaw acceleration beyond which a change counts as a jump, not as motion.
const JUMP: f64 = 10.0;

/// Position, velocity and acceleration as given; the heading within its rate limit. Derivatives that are not given are estimated.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct DirectReference {
    /// The way as it was sampled at `time_us`, and the heading at `yaw_time_us`.
    latest: PositionReference,
    time_us: u64,
    yaw_time_us: u64,
    accelerations: DerivativeEstimator<3>,
    yaw_rates: DerivativeEstimator<1>,
}

impl DirectReference {
    /// Goes on from a reference.
    pub fn new(now: &PositionReference, time_us: u64) -> Self {
        Self {
            latest: *now,
            time_us,
            yaw_time_us: time_us,
            accelerations: DerivativeEstimator::new(),
            yaw_rates: DerivativeEstimator::new(),
        }
    }

    /// The latest reference, moved on by its derivatives since it was sampled.
    pub fn reference(&self, time_us: u64) -> PositionReference {
        let since_s = |start_us: u64| time_us.saturating_sub(start_us) as f64 / 1e6;
        let heading = Heading::of(&self.latest.expected_after(since_s(self.yaw_time_us)));
        heading.on(&self.latest.expected_after(since_s(self.time_us)))
    }

    /// Looks at the input, more often than it is sampled: derivatives are estimated from the instants at which it changes.
    pub fn watch(&mut self, reference: &PositionReference, limits: &Limits, time_us: u64) {
        if gives_derivatives(reference) {
            self.accelerations = DerivativeEstimator::new();
        } else {
            let fastest = JUMP * limits.jerk_horizontal_m_s3.max(limits.jerk_vertical_m_s3);
            self.accelerations.observe(&reference.acceleration_m_s2, fastest, time_us);
        }
        if reference.yaw_acceleration_rad_s2 != 0.0 {
            self.yaw_rates = DerivativeEstimator::new();
        } else {
            let fastest = JUMP * limits.yaw_acceleration_rad_s2;
            self.yaw_rates.observe(&Vector1::new(reference.yaw_rate_rad_s), fastest, time_us);
        }
    }

    /// A sample of the way.
    pub fn sample(&mut self, reference: &PositionReference, limits: &Limits, time_us: u64) {
        let mut way = *reference;
        if !gives_derivatives(reference) {
            let Derivatives { first, second } = self.accelerations.at(time_us);
            // What the tilt command may do.
            way.jerk_m_s3 = first.cap_magnitude(GRAVITY_M_S2 * limits.tilt_rate_rad_s);
            way.snap_m_s4 = second.cap_magnitude(GRAVITY_M_S2 * limits.tilt_acceleration_rad_s2);
        }
        self.latest = Heading::of(&self.latest).on(&way);
        self.time_us = time_us;
    }

    /// A sample of the heading.
    pub fn sample_heading(&mut self, reference: &PositionReference, limits: &Limits, time_us: u64) {
        let elapsed_s = time_us.saturating_sub(self.yaw_time_us) as f64 / 1e6;
        let most = limits.yaw_rate_rad_s * elapsed_s;
        let held = &mut self.latest;
        let turned = wrapped(reference.yaw_rad - held.yaw_rad).clamp(-most, most);
        held.yaw_rad += turned;
        // A heading that moves has a rate, also when none was given.
        let given = reference.yaw_rate_rad_s;
        let rate = if given == 0.0 && elapsed_s > 0.0 { turned / elapsed_s } else { given };
        held.yaw_rate_rad_s = rate.clamp(-limits.yaw_rate_rad_s, limits.yaw_rate_rad_s);
        let acceleration = match reference.yaw_acceleration_rad_s2 {
            0.0 => self.yaw_rates.at(time_us).first.x,
            given => given,
        };
        // A rate at its limit stays there.
        let is_free = held.yaw_rate_rad_s == rate;
        held.yaw_acceleration_rad_s2 = if is_free { acceleration } else { 0.0 };
        self.yaw_time_us = time_us;
    }
}

/// Whether jerk and snap are given with the reference.
fn gives_derivatives(reference: &PositionReference) -> bool {
    let zero = Vector3::zeros();
    reference.jerk_m_s3 != zero || reference.snap_m_s4 != zero
}
