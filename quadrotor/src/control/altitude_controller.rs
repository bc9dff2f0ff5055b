//! Altitude: from z and its rate to the vertical acceleration G of (7).

use lmpc::{ControllerState, Sample};
use nalgebra::{Vector1, Vector2};
use serde::{Deserialize, Serialize};

use crate::control::activity::ControllerActivity;
use crate::control::governor::{Governor, integral_rate};
use crate::control::vehicle_motion::VehicleMotion;
use crate::design::capacities::ALTITUDE_MANY;
use crate::design::controller_limits::altitude_bounds;
use crate::guidance::reference_motion::ReferenceMotion;
use crate::{CascadeDesign, Configuration};

/// Share of the acceleration limit that braking before a distant set-point counts on.
const BRAKING_SHARE: f64 = 0.5;

/// State of the altitude controller.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AltitudeController {
    controller: ControllerState<2, 1, ALTITUDE_MANY>,
    reference: ReferenceMotion<1>,
}

impl AltitudeController {
    /// Takes over a vehicle at height z, m, as if it had been at rest there: its whole velocity then
    /// counts as motion to be explained, and is damped from the first sample on.
    pub fn new(z_m: f64) -> Self {
        let start = ControllerState::new(Vector2::new(z_m, 0.0), Vector1::zeros(), Vector1::zeros());
        Self { controller: start, reference: ReferenceMotion::default() }
    }

    /// One sample: G, m/s² down, within `range`, and how it was found.
    pub(crate) fn step(
        &mut self,
        configuration: &Configuration,
        design: &CascadeDesign,
        seen: &VehicleMotion<1>,
        reference: &ReferenceMotion<1>,
        range: (f64, f64),
    ) -> (f64, ControllerActivity) {
        let law = &design.altitude;
        let limits = &configuration.limits;
        let period_s = configuration.controllers.altitude.sample_time_s();
        let measured = Vector2::new(seen.position_m.x, seen.velocity_m_s.x);
        let [explained] = reference.increments_since(&self.reference).map(Vector2::from);
        let mut error = seen.position_m - reference.position;
        if configuration.controllers.governor {
            let governor = Governor {
                rate: integral_rate(&design.altitude_gains, 0, period_s),
                deceleration: BRAKING_SHARE * limits.acceleration_vertical_m_s2,
                // Below the set-point (z down) it climbs.
                speed: if error.x > 0.0 { limits.speed_up_m_s } else { limits.speed_down_m_s },
            };
            error = governor.seen_vector(&error);
        }
        let rate_m_s = reference.velocity.x;
        let moving_m_s = law.uncounted(&reference.velocity).x;
        let sample = Sample {
            measured,
            increment: measured - self.controller.measured() - explained,
            deviation: Vector2::new(error.x, seen.velocity_m_s.x - rate_m_s),
            error,
            input_reference: reference.acceleration_ahead,
            disturbance: seen.disturbance_m_s2,
            upper: &altitude_bounds(limits, range, rate_m_s, moving_m_s),
            ..Sample::default()
        };
        let step = law.step(&mut self.controller, &sample);
        self.reference = *reference;
        let wanted = step.input;
        let applied = Vector1::new(wanted.x.clamp(range.0, range.1));
        self.controller.apply(&applied);
        (applied.x, ControllerActivity::of(&step, &wanted, &applied))
    }

    /// Leaves to the feed-forward of the reference what it takes over of the feedback: so much more drag per mass, 1/s.
    pub(crate) fn feed_forward(&mut self, drag_1_s: f64) {
        let more = self.reference.velocity * drag_1_s;
        self.controller.turn_feedback(|feedback| feedback - more);
    }

    /// Expresses the acceleration that was applied last in other terms.
    pub(crate) fn translate(&mut self, term: impl Fn(&Vector1<f64>) -> Vector1<f64>) {
        self.controller.apply(&term(&self.controller.applied()));
    }
}
