//! Position: from x, y and their rates to tilt commands.

use lmpc::{ControllerState, Sample};
use nalgebra::{Vector2, Vector4};
use serde::{Deserialize, Serialize};

use crate::control::activity::ControllerActivity;
use crate::control::governor::{Governor, integral_rate};
use crate::control::vehicle_motion::VehicleMotion;
use crate::design::capacities::POSITION_MANY;
use crate::design::controller_limits::position_bounds;
use crate::guidance::reference_motion::ReferenceMotion;
use crate::{CascadeDesign, Configuration, GRAVITY_M_S2};

/// Share of the acceleration limit that braking before a distant set-point counts on. The loop's own
/// response to the governed error needs the rest.
const BRAKING_SHARE: f64 = 0.25;

/// State of the position controller.
///
/// Its inputs θ and φ are those of (14) for a heading of zero: ẍ = −g θ north and ÿ = g φ east hold
/// exactly, for any tilt and heading, because the cascade turns the acceleration that they stand for into
/// a direction of the thrust.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PositionController {
    controller: ControllerState<4, 2, POSITION_MANY>,
    reference: ReferenceMotion<2>,
}

impl PositionController {
    /// Takes over a vehicle at x, y, m, as if it had been at rest there.
    pub fn new(position_m: Vector2<f64>) -> Self {
        let measured = Vector4::new(position_m.x, 0.0, position_m.y, 0.0);
        let start = ControllerState::new(measured, Vector2::zeros(), Vector2::zeros());
        Self { controller: start, reference: ReferenceMotion::default() }
    }

    /// One sample: horizontal acceleration in NED, m/s², and how it was found. `tilt` is the largest |a|/g,
    /// and `limited` brings an acceleration within what the vehicle can do.
    pub(crate) fn step(
        &mut self,
        configuration: &Configuration,
        design: &CascadeDesign,
        seen: &VehicleMotion<2>,
        reference: &ReferenceMotion<2>,
        tilt: f64,
        limited: impl Fn(Vector2<f64>) -> Vector2<f64>,
    ) -> (Vector2<f64>, ControllerActivity) {
        let law = &design.position;
        let limits = &configuration.limits;
        let period_s = configuration.controllers.position.sample_time_s();
        let measured = interleaved(&seen.position_m, &seen.velocity_m_s);
        let [x, y] = reference.increments_since(&self.reference);
        let explained = Vector4::new(x[0], x[1], y[0], y[1]);
        let mut error = seen.position_m - reference.position;
        if configuration.controllers.governor {
            let linear = &design.position_gains;
            let governor = Governor {
                rate: integral_rate(linear, 0, period_s).min(integral_rate(linear, 1, period_s)),
                deceleration: BRAKING_SHARE * limits.acceleration_horizontal_m_s2,
                speed: limits.speed_horizontal_m_s,
            };
            error = governor.seen_vector(&error);
        }
        let moving = law.uncounted(&reference.velocity);
        let sample = Sample {
            measured,
            increment: measured - self.controller.measured() - explained,
            deviation: interleaved(&error, &(seen.velocity_m_s - reference.velocity)),
            error,
            input_reference: tilt_of(&reference.acceleration_ahead),
            disturbance: tilt_of(&seen.disturbance_m_s2),
            upper: &position_bounds(limits, tilt, period_s, &reference.velocity, &moving),
            ..Sample::default()
        };
        let step = law.step(&mut self.controller, &sample);
        self.reference = *reference;
        let wanted = acceleration_of(&step.input);
        let applied = limited(wanted);
        self.controller.apply(&tilt_of(&applied));
        (applied, ControllerActivity::of(&step, &wanted, &applied))
    }

    /// Leaves to the feed-forward of the reference what it takes over of the feedback: so much more drag per mass, 1/s.
    pub(crate) fn feed_forward(&mut self, drag_1_s: &Vector2<f64>) {
        let more = tilt_of(&drag_1_s.component_mul(&self.reference.velocity));
        self.controller.turn_feedback(|feedback| feedback - more);
    }

    /// Expresses the acceleration that was applied last in other terms.
    pub(crate) fn translate(&mut self, term: impl Fn(&Vector2<f64>) -> Vector2<f64>) {
        let applied = acceleration_of(&self.controller.applied());
        self.controller.apply(&tilt_of(&term(&applied)));
    }
}

/// x, ẋ, y, ẏ: the order of (14).
fn interleaved(position: &Vector2<f64>, velocity: &Vector2<f64>) -> Vector4<f64> {
    Vector4::new(position.x, velocity.x, position.y, velocity.y)
}

/// (11), (13): ẍ = −g θ, ÿ = g φ, input order θ, φ.
fn acceleration_of(tilt: &Vector2<f64>) -> Vector2<f64> {
    Vector2::new(-GRAVITY_M_S2 * tilt.x, GRAVITY_M_S2 * tilt.y)
}

fn tilt_of(acceleration: &Vector2<f64>) -> Vector2<f64> {
    Vector2::new(-acceleration.x / GRAVITY_M_S2, acceleration.y / GRAVITY_M_S2)
}
