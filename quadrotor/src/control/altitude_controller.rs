//! Altitude: from z and its rate to the vertical acceleration G of (7).

use lmpc::{ControllerState, Sample, StateFeedback};
use nalgebra::{Vector1, Vector3};
use serde::{Deserialize, Serialize};

use crate::control::activity::ControllerActivity;
use crate::control::governor::{Governor, integral_rate};
use crate::control::observed_motion::{LASTING_S, MotionSample, ObservedMotion};
use crate::control::vehicle_motion::VerticalMotion;
use crate::design::altitude_limits::altitude_bounds;
use crate::design::capacities::{ALTITUDE_FEW, ALTITUDE_MANY};
use crate::design::position_limits::{closing_share, horizon_m};
use crate::guidance::reference_motion::ReferenceMotion;
use crate::{CascadeDesign, Configuration};

/// Accelerations below this count as this for the horizon, m/s².
const SLOWEST_M_S2: f64 = 0.5;
/// Share of the acceleration limit with which the regulator's error is counted on to be braked.
const BRAKING_SHARE: f64 = 0.25;

/// State of the altitude controller.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AltitudeController {
    controller: ControllerState<3, 1, ALTITUDE_MANY, f64, ALTITUDE_FEW>,
    observed: ObservedMotion<3, 1>,
    reference: ReferenceMotion<1>,
}

impl AltitudeController {
    /// Takes over a vehicle at height z, m. Its whole velocity is damped from the first sample on: a law that goes by increments takes it
    /// to have been at rest there, one that goes by a model to have been damped so far.
    pub fn new(z_m: f64) -> Self {
        let start =
            ControllerState::new(Vector3::new(z_m, 0.0, 0.0), Vector1::zeros(), Vector1::zeros()).keeping();
        Self { controller: start, observed: ObservedMotion::default(), reference: ReferenceMotion::default() }
    }

    /// One sample: G, m/s² down, within `range`, and how it was found.
    pub(crate) fn step(
        &mut self,
        configuration: &Configuration,
        design: &CascadeDesign,
        seen: &VerticalMotion,
        reference: &ReferenceMotion<1>,
        range: (f64, f64),
    ) -> (f64, ControllerActivity) {
        let law = &design.altitude.law;
        let measured = Vector3::new(seen.position_m, seen.velocity_m_s, seen.acceleration_m_s2);
        let [[position, velocity, acceleration, ..]] = reference.increments_since(&self.reference);
        let error = planned_error_m(configuration, law.regulator(), seen, reference, range);
        let rate_m_s = reference.velocity.x;
        let lag_s = configuration.airframe.mean_rotor_lag_s();
        let deviation =
            Vector3::new(error.x, seen.velocity_m_s - rate_m_s, seen.acceleration_m_s2 - reference.thrust.x);
        // The rotors answer late: z̈ = G − T z⃛.
        let input_reference = reference.thrust + reference.thrust_jerk * lag_s;
        self.take_over(design, deviation.y, &input_reference, range);
        let motion = MotionSample {
            deviation,
            change: measured - self.controller.measured() - Vector3::new(position, velocity, acceleration),
            feedback: self.controller.feedback(),
            jump: Vector3::zeros(),
        };
        let sample_time_s = configuration.controllers.altitude.sample_time_s();
        let model = design.altitude.motion.as_ref();
        // One that is estimated from noise or from places alone comes late enough.
        let lag_s = if design.estimator.disturbance_lag_s > 0.0 { 0.0 } else { LASTING_S };
        let [increment, passing] = self.observed.step(model, &motion, (sample_time_s, lag_s));
        let sample = Sample {
            measured,
            increment,
            // What disturbs the vehicle accelerates it, too.
            deviation: deviation + Vector3::z() * seen.disturbance_m_s2,
            error,
            input_reference,
            disturbance: Vector1::new(seen.disturbance_m_s2),
            upper: &altitude_bounds(&configuration.limits, range, rate_m_s),
            ..Sample::default()
        };
        let step = law.step(&mut self.controller, &sample);
        self.reference = *reference;
        let wanted = step.input + law.answer_to(&passing);
        let applied = Vector1::new(wanted.x.clamp(range.0, range.1));
        self.controller.apply(&applied);
        (applied.x, ControllerActivity::of(&step, &wanted, &applied))
    }

    /// Before the first sample of a vehicle that deviates at a velocity, m/s: see [`ObservedMotion::first_feedback`]. Accelerations do not
    /// count: they follow from a mass that is only believed in.
    fn take_over(
        &mut self,
        design: &CascadeDesign,
        velocity_m_s: f64,
        input_reference: &Vector1<f64>,
        (least, most): (f64, f64),
    ) {
        let (law, model) = (&design.altitude.law, design.altitude.motion.as_ref());
        let answer = |increment: &_| law.answer_to(increment);
        let moving = Vector3::new(0.0, velocity_m_s, 0.0);
        let Some(feedback) = self.observed.first_feedback(model, answer, &moving) else { return };
        let applied = Vector1::new((input_reference.x + feedback.x).clamp(least, most));
        self.controller.turn_feedback(|_| applied - input_reference);
    }

    /// The part of the last command that the reference requires, m/s² down.
    pub(crate) fn reference_m_s2(&self) -> f64 {
        self.controller.input_reference().x
    }

    /// Vehicle and reference are elsewhere, m down: neither has moved.
    pub(crate) fn shift(&mut self, by_m: f64) {
        self.controller.turn(|measured| measured + Vector3::x() * by_m, Vector1::clone_owned);
        self.reference.position.x += by_m;
    }

    /// Leaves to the feed-forward of the reference what it takes over of the feedback: so much more drag per mass, 1/s.
    pub(crate) fn feed_forward(&mut self, drag_1_s: f64) {
        let more = self.reference.velocity * drag_1_s;
        self.controller.turn_feedback(|feedback| feedback - more);
        self.observed.believe(&Vector3::new(0.0, 0.0, -more.x));
    }

    /// Expresses the accelerations that were measured and applied last in other terms.
    pub(crate) fn translate(&mut self, term: impl Fn(&Vector1<f64>) -> Vector1<f64>) {
        let applied = term(&self.controller.applied());
        let before = self.controller.measured();
        self.controller.turn(
            |state| Vector3::new(state.x, state.y, term(&Vector1::new(state.z)).x),
            Vector1::clone_owned,
        );
        self.controller.apply(&applied);
        self.observed.believe(&(self.controller.measured() - before));
    }
}

/// What of the altitude error, z down, is planned with: as far as it can be braked within the horizon, and as the governor lets a
/// regulator see it.
fn planned_error_m(
    configuration: &Configuration,
    regulator: Option<&StateFeedback<3, 1, 1>>,
    seen: &VerticalMotion,
    reference: &ReferenceMotion<1>,
    range: (f64, f64),
) -> Vector1<f64> {
    let limits = &configuration.limits;
    let error = seen.position_m - reference.position.x;
    // Below the set-point it climbs.
    let (ahead_m_s, speed_m_s) = if error > 0.0 {
        (-reference.velocity.x, limits.speed_up_m_s)
    } else {
        (reference.velocity.x, limits.speed_down_m_s)
    };
    let fastest = limits.speed_up_m_s.max(limits.speed_down_m_s);
    let weakest = range.1.min(-range.0).max(SLOWEST_M_S2);
    let sight = horizon_m(fastest * closing_share(speed_m_s, ahead_m_s), weakest);
    let error = Vector1::new(error.clamp(-sight, sight));
    match regulator {
        Some(regulator) if configuration.controllers.governor => {
            let governor = Governor {
                rate: integral_rate(regulator, 0, configuration.controllers.altitude.sample_time_s()),
                deceleration: BRAKING_SHARE * limits.acceleration_vertical_m_s2,
                speed: speed_m_s,
            };
            governor.seen_vector(&error)
        }
        _ => error,
    }
}
