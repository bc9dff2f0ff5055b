//! One axis of the attitude under its controller, for small signals.

use crate::control::attitude_controller::SMOOTHING_S;
use crate::control::estimator::lag_kept;
use crate::design::estimator_design::Axis;
use crate::design::stability::linear_law::{ChannelSample, LinearLaw};
use crate::{CascadeDesign, Configuration};

/// One axis of rotation: what its controller, the rotors and the estimator do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TurningAxis {
    /// From angles to angular accelerations.
    law: LinearLaw<2>,
    is_incremental: bool,
    /// Inertia that the controller believes in, as a multiple of the true one.
    believed: f64,
    sample_time_s: f64,
    /// Share of a deviation of the rotors' speed that is left after a sample time.
    kept: f64,
    output_feedback: bool,
    estimator: Axis,
}

/// State of a [`TurningAxis`]: small deviations from hover.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Turning {
    /// rad.
    pub(crate) angle: f64,
    /// rad/s.
    pub(crate) rate: f64,
    /// That of the rotors' torque, rad/s².
    pub(crate) acceleration: f64,
    /// That which they are asked for, rad/s².
    pub(crate) command: f64,
    error: f64,
    rate_error: f64,
    feedback: f64,
    reference_rate: f64,
    reference_acceleration: f64,
    /// Angle, rate and unexplained acceleration.
    pub(crate) estimate: [f64; 3],
}

impl Turning {
    /// Number of values.
    pub(crate) const SIZE: usize = 12;
    /// Places of the angle and of the command among them.
    pub(crate) const ANGLE: usize = 0;
    pub(crate) const COMMAND: usize = 3;

    pub(crate) fn from_values(values: &[f64; Self::SIZE]) -> Self {
        let [angle, rate, acceleration, command, error, rate_error, feedback, ..] = *values;
        let [.., reference_rate, reference_acceleration, e0, e1, e2] = *values;
        Self {
            angle,
            rate,
            acceleration,
            command,
            error,
            rate_error,
            feedback,
            reference_rate,
            reference_acceleration,
            estimate: [e0, e1, e2],
        }
    }

    pub(crate) fn values(&self) -> [f64; Self::SIZE] {
        let [e0, e1, e2] = self.estimate;
        [
            self.angle,
            self.rate,
            self.acceleration,
            self.command,
            self.error,
            self.rate_error,
            self.feedback,
            self.reference_rate,
            self.reference_acceleration,
            e0,
            e1,
            e2,
        ]
    }
}

impl TurningAxis {
    /// The roll (0), pitch (1) or yaw (2) axis.
    pub(crate) fn new(
        configuration: &Configuration,
        design: &CascadeDesign,
        laws: &[LinearLaw<2>; 3],
        axis: usize,
    ) -> Self {
        let sample_time_s = configuration.controllers.attitude.sample_time_s();
        Self {
            law: laws[axis].scaled(1.0 / configuration.airframe.inertia_kg_m2[axis]),
            is_incremental: design.attitude.is_incremental(),
            believed: configuration.controllers.mass_factor,
            sample_time_s,
            kept: lag_kept(configuration, sample_time_s),
            output_feedback: configuration.sensors.output_feedback,
            estimator: design.estimator.rotation,
        }
    }

    /// The same axis without the torque that its reference needs: what is left when torques saturate.
    pub(crate) fn without_feed_forward(&self) -> Self {
        Self { is_incremental: true, ..*self }
    }

    /// Whether the controller adds the torque that its reference needs.
    pub(crate) fn has_feed_forward(&self) -> bool {
        !self.is_incremental
    }

    /// Angle and rate as the controllers see them, with errors of the measured ones.
    pub(crate) fn seen(&self, state: &Turning, noise: [f64; 2]) -> [f64; 2] {
        if self.output_feedback {
            [state.estimate[0], state.estimate[1]]
        } else {
            [state.angle + noise[0], state.rate + noise[1]]
        }
    }

    /// A sample of the attitude controller: with a reference for the angle and its rate, and errors of the measured ones.
    pub(crate) fn sample(&self, state: &mut Turning, reference: [f64; 2], noise: [f64; 2]) {
        let measured = [state.angle + noise[0], state.rate + noise[1]];
        let seen = self.seen(state, noise);
        let deviation = [seen[0] - reference[0], seen[1] - reference[1]];

        let acceleration = (reference[1] - state.reference_rate) / self.sample_time_s;
        let share = (self.sample_time_s / SMOOTHING_S).min(1.0);
        state.reference_acceleration += (acceleration - state.reference_acceleration) * share;
        state.reference_rate = reference[1];
        let ahead = if self.is_incremental { 0.0 } else { self.believed * state.reference_acceleration };

        state.feedback = self.law.feedback(&ChannelSample {
            increment: [deviation[0] - state.error, deviation[1] - state.rate_error],
            deviation,
            held: state.feedback,
            disturbance: self.believed * state.estimate[2],
        });
        [state.error, state.rate_error] = deviation;
        state.command = state.feedback + ahead;

        let after = state.command + (state.acceleration - state.command) * self.kept;
        let mean = (state.acceleration + after) / 2.0 / self.believed;
        let next = self.estimator.predict(&state.estimate.into(), &[mean].into(), &[measured[0]].into());
        state.estimate = next.into();
    }
}
