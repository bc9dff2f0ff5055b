//! Position: from x, y and their rates to tilt commands.

use lmpc::ControllerState;
use nalgebra::{Vector2, Vector4};
use serde::{Deserialize, Serialize};

use crate::governor::{Governor, integral_rate};
use crate::reference_motion::ReferenceMotion;
use crate::{CascadeDesign, ControllerSettings, GRAVITY_M_S2, Limits};

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
    lmpc: ControllerState<4, 2>,
    reference: ReferenceMotion<2>,
}

impl PositionController {
    /// Takes over a vehicle at x, y, m, as if it had been at rest there.
    pub fn new(position_m: Vector2<f64>) -> Self {
        let measured = Vector4::new(position_m.x, 0.0, position_m.y, 0.0);
        Self {
            lmpc: ControllerState::new(measured, Vector2::zeros(), Vector2::zeros()),
            reference: ReferenceMotion::default(),
        }
    }

    /// One sample: horizontal acceleration in NED, m/s², from position, m, and velocity, m/s. `limited`
    /// brings an acceleration within what the vehicle can do.
    pub fn step(
        &mut self,
        design: &CascadeDesign,
        settings: &ControllerSettings<2>,
        limits: &Limits,
        (position_m, velocity_m_s): (Vector2<f64>, Vector2<f64>),
        reference: &ReferenceMotion<2>,
        limited: impl Fn(Vector2<f64>) -> Vector2<f64>,
    ) -> Vector2<f64> {
        let law = &design.position;
        let period_s = settings.sample_time_s();
        let measured = interleaved(&position_m, &velocity_m_s);
        let [x, y] = reference.increments_since(&self.reference, period_s);
        let explained = Vector4::new(x[0], x[1], y[0], y[1]);
        let governor = Governor {
            rate: integral_rate(law, 0, period_s).min(integral_rate(law, 1, period_s)),
            deceleration: BRAKING_SHARE * limits.acceleration_horizontal_m_s2,
            speed: limits.speed_horizontal_m_s,
        };
        let error = governor.seen_vector(&(position_m - reference.position));
        let ahead = tilt_of(&reference.acceleration_ahead);
        let delta = measured - self.lmpc.measured() - explained;
        let step = law.step_from(&mut self.lmpc, &measured, &delta, &error, &ahead);
        self.reference = *reference;
        let applied = limited(acceleration_of(&step.input));
        self.lmpc.apply(&tilt_of(&applied));
        applied
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
