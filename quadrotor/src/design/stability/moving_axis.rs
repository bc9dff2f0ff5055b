//! One axis of the position under its controller, for small signals.

use crate::control::estimator::shortfall_share;
use crate::design::estimator_design::Axis;
use crate::design::stability::linear_law::{ChannelSample, LinearLaw};
use crate::design::stability::loop_events::LoopEvent;
use crate::{CascadeDesign, Configuration};

/// One axis of translation: what its controller and the estimator do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MovingAxis {
    /// From positions to accelerations.
    law: LinearLaw<2>,
    output_feedback: bool,
    estimator: Axis,
    shortfall_share: f64,
}

/// State of a [`MovingAxis`]: small deviations from hover.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Moving {
    /// m.
    pub(crate) position: f64,
    /// m/s.
    pub(crate) velocity: f64,
    measured: [f64; 2],
    feedback: f64,
    /// The commanded acceleration goes evenly from here …
    from: f64,
    /// … to here, m/s².
    to: f64,
    /// Position, velocity and unexplained acceleration.
    estimate: [f64; 3],
    shortfall: f64,
}

impl Moving {
    /// Number of values.
    pub(crate) const SIZE: usize = 11;
    /// Place of the position among them.
    pub(crate) const POSITION: usize = 0;

    pub(crate) fn from_values(values: &[f64; Self::SIZE]) -> Self {
        let [position, velocity, m0, m1, feedback, from, to, e0, e1, e2, shortfall] = *values;
        Self { position, velocity, measured: [m0, m1], feedback, from, to, estimate: [e0, e1, e2], shortfall }
    }

    pub(crate) fn values(&self) -> [f64; Self::SIZE] {
        let ([m0, m1], [e0, e1, e2]) = (self.measured, self.estimate);
        [self.position, self.velocity, m0, m1, self.feedback, self.from, self.to, e0, e1, e2, self.shortfall]
    }

    /// The acceleration that is commanded when this share of the sample time has passed, m/s².
    pub(crate) fn commanded(&self, share: f64) -> f64 {
        self.from + (self.to - self.from) * share
    }
}

impl MovingAxis {
    /// Under this law, from m and m/s to m/s².
    pub(crate) fn new(configuration: &Configuration, design: &CascadeDesign, law: LinearLaw<2>) -> Self {
        Self {
            law,
            output_feedback: configuration.sensors.output_feedback,
            estimator: design.estimator.translation,
            shortfall_share: shortfall_share(design.estimator.sample_time_s),
        }
    }

    /// A sample of the axis's controller, with errors of the measured position and velocity.
    pub(crate) fn sample(&self, state: &mut Moving, event: &LoopEvent, noise: [f64; 2]) {
        let [position, velocity, disturbance] = state.estimate;
        let seen = if self.output_feedback {
            [position - velocity * event.early_s, velocity]
        } else {
            [state.position + noise[0], state.velocity + noise[1]]
        };
        state.feedback = self.law.feedback(&ChannelSample {
            increment: [seen[0] - state.measured[0], seen[1] - state.measured[1]],
            deviation: seen,
            held: state.feedback,
            disturbance: disturbance + state.shortfall,
        });
        state.measured = seen;
        (state.from, state.to) = (state.to, state.feedback);
    }

    /// The estimator's step to the next sample of the attitude controller: by the acceleration that it models and the one
    /// that answers the command, m/s², and the error of the measured position, m.
    pub(crate) fn predict(&self, state: &mut Moving, modelled: f64, answer: f64, noise: f64) {
        state.shortfall += (modelled - answer - state.shortfall) * self.shortfall_share;
        let measured = state.position + noise;
        state.estimate =
            self.estimator.predict(&state.estimate.into(), &[modelled].into(), &[measured].into()).into();
    }
}
