//! Attitude: from the attitude and body rates to torques.

use lmpc::{ControllerState, Sample};
use nalgebra::{UnitQuaternion, Vector3, Vector6};
use serde::{Deserialize, Serialize};

use crate::attitude::{attitude_error, turned};
use crate::control::activity::ControllerActivity;
use crate::control::governor::{Governor, proportional_rate};
use crate::design::capacities::ATTITUDE_MANY;
use crate::design::loop_design::LoopDesign;
use crate::{CascadeDesign, Configuration, Limits};

/// Share of the torque-limited angular acceleration that braking a large rotation counts on.
const BRAKING_SHARE: f64 = 0.5;

/// Time over which steps of the reference's rate are spread, s: those of the position controller.
pub(crate) const SMOOTHING_S: f64 = 0.05;

/// What is known of the vehicle's rotation, measured or estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct VehicleRotation {
    /// FRD into NED.
    pub(crate) attitude: UnitQuaternion<f64>,
    /// p, q, r, rad/s.
    pub(crate) body_rate_rad_s: Vector3<f64>,
    /// Estimated torque that the rotors do not explain, N·m.
    pub(crate) disturbance_n_m: Vector3<f64>,
}

/// State of the attitude controller.
///
/// The model (23) has Euler angles; here their error is the rotation from the reference in body axes,
/// which for small angles is the same and has no singularity. The whole state is the error: the
/// attitude reference moves continuously.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AttitudeController {
    controller: ControllerState<6, 3, ATTITUDE_MANY>,
    attitude: UnitQuaternion<f64>,
    /// The error that the controller saw last, rad.
    error_rad: Vector3<f64>,
    /// p, q, r less their references, rad/s.
    rate_error_rad_s: Vector3<f64>,
    /// Integral action of the last step, N·m.
    integral_n_m: Vector3<f64>,
    reference: ReferenceRotation,
}

/// The motion of the attitude reference, in its own axes.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
struct ReferenceRotation {
    rate_rad_s: Vector3<f64>,
    /// Smoothed: the rate itself moves in steps.
    acceleration_rad_s2: Vector3<f64>,
}

impl ReferenceRotation {
    fn go_on(&mut self, rate_rad_s: &Vector3<f64>, interval_s: f64) {
        let acceleration = (rate_rad_s - self.rate_rad_s) / interval_s;
        let share = (interval_s / SMOOTHING_S).min(1.0);
        self.acceleration_rad_s2 += (acceleration - self.acceleration_rad_s2) * share;
        self.rate_rad_s = *rate_rad_s;
    }
}

impl AttitudeController {
    /// Takes over a vehicle, as if it had been on its reference: the whole error and the whole rate count
    /// from the first sample on.
    pub fn new(attitude: &UnitQuaternion<f64>) -> Self {
        let start = ControllerState::new(Vector6::zeros(), Vector3::zeros(), Vector3::zeros());
        Self {
            controller: start,
            attitude: *attitude,
            error_rad: Vector3::zeros(),
            rate_error_rad_s: Vector3::zeros(),
            integral_n_m: Vector3::zeros(),
            reference: ReferenceRotation::default(),
        }
    }

    /// One sample: torques in FRD, N·m, without the gyroscopic ones, and how they were found, from attitude,
    /// body rates, rad/s, and the estimated disturbing torque, N·m, and from the references, the rate in the
    /// axes of the reference. `bounds` are those of the rotors' thrusts, `interval_s` the time since the last sample.
    /// Report what the rotors were asked for in the end with [`AttitudeController::apply`].
    pub(crate) fn step(
        &mut self,
        configuration: &Configuration,
        design: &CascadeDesign,
        seen: &VehicleRotation,
        (reference, reference_rate_rad_s): (&UnitQuaternion<f64>, &Vector3<f64>),
        bounds: &[f64],
        interval_s: f64,
    ) -> (Vector3<f64>, ControllerActivity) {
        let attitude = &seen.attitude;
        self.turn_with_the_body(attitude);
        let to_body = attitude.inverse() * reference;
        let whole = attitude_error(reference, attitude);
        let error_rad = governed(design, &configuration.limits, &whole);
        let rate_error_rad_s = seen.body_rate_rad_s - to_body * reference_rate_rad_s;
        self.reference.go_on(reference_rate_rad_s, interval_s);
        let law = &design.attitude;
        // A step of the reference's rate is motion of the error, which moves an incremental law at once.
        let input_reference = if law.is_incremental() {
            Vector3::zeros()
        } else {
            (to_body * self.reference.acceleration_rad_s2)
                .component_mul(&configuration.believed_inertia_kg_m2())
        };
        let sample = Sample {
            measured: interleaved(&error_rad, &rate_error_rad_s),
            increment: interleaved(
                &(error_rad - self.error_rad),
                &(rate_error_rad_s - self.rate_error_rad_s),
            ),
            deviation: interleaved(&error_rad, &rate_error_rad_s),
            // What an incremental law integrates; its proportional part is in the motion.
            error: integrable(&whole, &error_rad),
            input_reference,
            disturbance: seen.disturbance_n_m,
            upper: bounds,
            ..Sample::default()
        };
        let step = law.step(&mut self.controller, &sample);
        self.error_rad = error_rad;
        self.rate_error_rad_s = rate_error_rad_s;
        self.integral_n_m = step.integral;
        (step.input, ControllerActivity::from(&step))
    }

    /// Expresses what is remembered in the body axes of now. A lean stays where it is in the world while the body
    /// spins about its thrust axis; an integral left behind in turning axes would push sideways.
    fn turn_with_the_body(&mut self, attitude: &UnitQuaternion<f64>) {
        let spun_rad = turned(&self.attitude, attitude).z;
        let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.0, 0.0, -spun_rad));
        self.controller.turn_feedback(|torque| turn * torque);
        self.error_rad = turn * self.error_rad;
        self.rate_error_rad_s = turn * self.rate_error_rad_s;
        self.attitude = *attitude;
    }

    /// Expresses what was asked for last in other terms.
    pub(crate) fn translate(&mut self, term: impl Fn(&Vector3<f64>) -> Vector3<f64>) {
        self.controller.turn_feedback(|torque| term(torque));
        self.integral_n_m = term(&self.integral_n_m);
    }

    /// Goes on under another law of the same torque. An incremental law has the torque that its reference needs in its
    /// feedback, the others beside it.
    pub(crate) fn hand_over(&mut self, before: &CascadeDesign, after: &LoopDesign) {
        let is_incremental = after.cascade.attitude.is_incremental();
        if before.attitude.is_incremental() == is_incremental {
            return;
        }
        let input_reference = if is_incremental {
            Vector3::zeros()
        } else {
            // In the axes of the reference, which differ from the body's by the small error.
            self.reference.acceleration_rad_s2.component_mul(&after.configuration.believed_inertia_kg_m2())
        };
        self.controller =
            ControllerState::new(self.controller.measured(), self.controller.applied(), input_reference);
        self.integral_n_m = Vector3::zeros();
    }

    /// Reports the torques, N·m, that the rotors were asked for.
    pub(crate) fn apply(&mut self, design: &CascadeDesign, torque_n_m: &Vector3<f64>) {
        let controller = &mut self.controller;
        if design.attitude.is_incremental() {
            controller.apply_holding_integral(torque_n_m, &self.integral_n_m);
        } else {
            controller.apply(torque_n_m);
        }
    }
}

/// The error that the controller may see: leaning as one vector, the heading for itself.
fn governed(design: &CascadeDesign, limits: &Limits, error_rad: &Vector3<f64>) -> Vector3<f64> {
    let leaning = Governor {
        rate: proportional_rate(&design.attitude_gains, 0).min(proportional_rate(&design.attitude_gains, 1)),
        deceleration: BRAKING_SHARE * limits.tilt_acceleration_rad_s2,
        speed: limits.tilt_rate_rad_s,
    };
    let turning = Governor {
        rate: proportional_rate(&design.attitude_gains, 2),
        deceleration: limits.yaw_acceleration_rad_s2,
        speed: limits.yaw_rate_rad_s,
    };
    let lean = leaning.seen_vector(&error_rad.xy());
    let turn = turning.seen_vector(&error_rad.fixed_rows::<1>(2).into_owned());
    Vector3::new(lean.x, lean.y, turn.x)
}

/// The error that is integrated: while a large error is closed at the governed rate, integrating it would
/// only exceed that rate. It fades out as the governed error falls behind the whole one, and is gone at half.
fn integrable(whole: &Vector3<f64>, governed: &Vector3<f64>) -> Vector3<f64> {
    let share =
        |governed: f64, whole: f64| if whole > 0.0 { (2.0 * governed / whole - 1.0).max(0.0) } else { 1.0 };
    let lean = governed.xy() * share(governed.xy().norm(), whole.xy().norm());
    let turn = governed.z * share(governed.z.abs(), whole.z.abs());
    Vector3::new(lean.x, lean.y, turn)
}

/// φ, φ̇, θ, θ̇, ψ, ψ̇: the order of (22).
fn interleaved(angle: &Vector3<f64>, rate: &Vector3<f64>) -> Vector6<f64> {
    Vector6::new(angle.x, rate.x, angle.y, rate.y, angle.z, rate.z)
}
