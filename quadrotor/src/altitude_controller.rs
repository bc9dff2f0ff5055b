//! Altitude: from z and its rate to the vertical acceleration G of (7).

use lmpc::ControllerState;
use nalgebra::{Vector1, Vector2};
use serde::{Deserialize, Serialize};

use crate::governor::{Governor, integral_rate};
use crate::reference_motion::ReferenceMotion;
use crate::{CascadeDesign, Configuration};

/// Share of the acceleration limit that braking before a distant set-point counts on.
const BRAKING_SHARE: f64 = 0.5;

/// State of the altitude controller.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AltitudeController {
    lmpc: ControllerState<2, 1>,
    reference: ReferenceMotion<1>,
}

impl AltitudeController {
    /// Takes over a vehicle at height z, m, as if it had been at rest there: its whole velocity then
    /// counts as motion to be explained, and is damped from the first sample on.
    pub fn new(z_m: f64) -> Self {
        Self {
            lmpc: ControllerState::new(Vector2::new(z_m, 0.0), Vector1::zeros(), Vector1::zeros()),
            reference: ReferenceMotion::default(),
        }
    }

    /// One sample: G, m/s² down, from z, m, and its rate, m/s, within `range`.
    pub fn step(
        &mut self,
        design: &CascadeDesign,
        configuration: &Configuration,
        [z_m, rate_m_s]: [f64; 2],
        reference: &ReferenceMotion<1>,
        range: (f64, f64),
    ) -> f64 {
        let law = &design.altitude;
        let limits = &configuration.limits;
        let period_s = configuration.controllers.altitude.sample_time_s();
        let measured = Vector2::new(z_m, rate_m_s);
        let [explained] = reference.increments_since(&self.reference, period_s).map(Vector2::from);
        let error = z_m - reference.position.x;
        let governor = Governor {
            rate: integral_rate(law, 0, period_s),
            deceleration: BRAKING_SHARE * limits.acceleration_vertical_m_s2,
            // Below the set-point (z down) it climbs.
            speed: if error > 0.0 { limits.speed_up_m_s } else { limits.speed_down_m_s },
        };
        let delta = measured - self.lmpc.measured() - explained;
        let step = law.step_from(
            &mut self.lmpc,
            &measured,
            &delta,
            &governor.seen_vector(&Vector1::new(error)),
            &reference.acceleration_ahead,
        );
        self.reference = *reference;
        let applied = step.input.x.clamp(range.0, range.1);
        self.lmpc.apply(&Vector1::new(applied));
        applied
    }
}
