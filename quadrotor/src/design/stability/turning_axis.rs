//! One axis of the attitude under its controller, for small signals.

use lmpc::ModelIncrement;

use crate::control::attitude_reference::SMOOTHING_S;
use crate::design::attitude_design::AXIS_STATES;
use crate::design::axis_predictor::AxisPredictor;
use crate::design::stability::linear_law::{ChannelSample, LinearLaw};
use crate::{CascadeDesign, Configuration};

/// One axis of rotation: what its controller, the rotors and the estimator do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TurningAxis {
    /// From angles to angular accelerations of the believed inertia.
    law: LinearLaw<AXIS_STATES>,
    motion: Option<ModelIncrement<AXIS_STATES, 1>>,
    is_incremental: bool,
    /// Inertia that the controller believes in, as a multiple of the true one.
    believed: f64,
    sample_time_s: f64,
    /// The torque is known to act together with its rate of change times this, s.
    lead_s: f64,
    /// Share of a deviation of the rotors' speed that is left after a sample time.
    kept: f64,
    output_feedback: bool,
    estimator: AxisPredictor,
    /// Whether a change of the unexplained acceleration is surely one: noise hides small ones.
    is_sure: bool,
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
    /// Angle, rate and the rotors' acceleration less their references, at the last sample.
    deviation: [f64; AXIS_STATES],
    feedback: f64,
    reference_rate: f64,
    reference_acceleration: f64,
    /// Angle, rate and unexplained acceleration.
    pub(crate) estimate: [f64; 3],
    /// That acceleration at the last sample.
    disturbance: f64,
}

impl Turning {
    /// Number of values.
    pub(crate) const SIZE: usize = 14;
    /// Places of the angle and of the command among them.
    pub(crate) const ANGLE: usize = 0;
    pub(crate) const COMMAND: usize = 3;

    pub(crate) fn from_values(values: &[f64; Self::SIZE]) -> Self {
        let [angle, rate, acceleration, command, d0, d1, d2, feedback, ..] = *values;
        let [.., reference_rate, reference_acceleration, e0, e1, e2, disturbance] = *values;
        Self {
            angle,
            rate,
            acceleration,
            command,
            deviation: [d0, d1, d2],
            feedback,
            reference_rate,
            reference_acceleration,
            estimate: [e0, e1, e2],
            disturbance,
        }
    }

    pub(crate) fn values(&self) -> [f64; Self::SIZE] {
        let ([d0, d1, d2], [e0, e1, e2]) = (self.deviation, self.estimate);
        [
            self.angle,
            self.rate,
            self.acceleration,
            self.command,
            d0,
            d1,
            d2,
            self.feedback,
            self.reference_rate,
            self.reference_acceleration,
            e0,
            e1,
            e2,
            self.disturbance,
        ]
    }
}

impl TurningAxis {
    /// Of roll, pitch or yaw, 0 to 2, under this law.
    pub(crate) fn new(
        configuration: &Configuration,
        design: &CascadeDesign,
        (axis, law): (usize, LinearLaw<AXIS_STATES>),
    ) -> Self {
        let sample_time_s = configuration.controllers.attitude.sample_time_s();
        Self {
            law,
            motion: design.attitude.motion,
            is_incremental: design.attitude.is_incremental(),
            believed: configuration.controllers.mass_factor,
            sample_time_s,
            lead_s: 0.0,
            kept: design.thrust_lag.kept(),
            output_feedback: configuration.sensors.output_feedback,
            estimator: design.estimator.rotation[axis],
            is_sure: design.estimator.unsure_rad_s2[axis] == 0.0,
        }
    }

    /// The same axis with a torque that acts together with its rate of change times a lead, s.
    pub(crate) fn leading(&self, lead_s: f64) -> Self {
        Self { lead_s, ..*self }
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

    /// Angular accelerations that the rotors are believed to make and that feedback has asked for, rad/s².
    pub(crate) fn accelerations(&self, state: &Turning) -> [f64; 2] {
        [state.acceleration / self.believed, state.feedback]
    }

    /// A sample of the attitude controller: with a reference for the angle and its rate, and errors of the measured ones.
    pub(crate) fn sample(&self, state: &mut Turning, reference: [f64; 2], noise: [f64; 2]) {
        let measured = [state.angle + noise[0], state.rate + noise[1]];
        let seen = self.seen(state, noise);
        let acceleration = (reference[1] - state.reference_rate) / self.sample_time_s;
        let share = (self.sample_time_s / SMOOTHING_S).min(1.0);
        state.reference_acceleration += (acceleration - state.reference_acceleration) * share;
        state.reference_rate = reference[1];
        let ahead = if self.is_incremental { 0.0 } else { state.reference_acceleration };

        let reached = state.acceleration / self.believed;
        // What disturbs the vehicle turns it, too.
        let reached = reached + state.estimate[2];
        let deviation = [seen[0] - reference[0], seen[1] - reference[1], reached - ahead];
        state.feedback = self.law.feedback(&ChannelSample {
            increment: match &self.motion {
                Some(motion) => {
                    let driving = [state.feedback + state.estimate[2]];
                    let mut increment = motion.that_led_to(&deviation.into(), &driving.into());
                    increment[2] += if self.is_sure { state.estimate[2] - state.disturbance } else { 0.0 };
                    increment.into()
                }
                None => core::array::from_fn(|place| deviation[place] - state.deviation[place]),
            },
            deviation,
            held: state.feedback,
            disturbance: state.estimate[2],
        });
        state.deviation = deviation;
        state.disturbance = state.estimate[2];
        // J_believed u makes more, or less, of the true inertia.
        state.command = self.believed * (state.feedback + ahead);

        let after = state.command + (state.acceleration - state.command) * self.kept;
        let change_1_s = (after - state.acceleration) / self.sample_time_s;
        let mean = ((state.acceleration + after) / 2.0 + self.lead_s * change_1_s) / self.believed;
        let next = self.estimator.predict(&state.estimate, mean, measured);
        state.estimate = next.into();
    }
}
