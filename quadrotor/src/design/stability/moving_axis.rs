//! One axis of the position under its controller, for small signals.

use crate::design::estimator_design::Axis;
use crate::design::stability::linear_law::{ChannelSample, LinearLaw};
use crate::design::stability::loop_events::LoopEvent;
use crate::{CascadeDesign, Configuration};

/// One axis of translation: what its controller and the estimator do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MovingAxis<const K: usize> {
    /// From positions to accelerations.
    law: LinearLaw<K>,
    output_feedback: bool,
    estimator: Axis,
}

/// State of a [`MovingAxis`]: small deviations from hover.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Moving {
    /// m.
    pub(crate) position: f64,
    /// m/s.
    pub(crate) velocity: f64,
    /// Position and its derivatives at the last sample, as far as the law goes by them.
    measured: [f64; 6],
    /// The commanded acceleration, m/s².
    pub(crate) feedback: f64,
    /// Position, velocity and unexplained acceleration.
    estimate: [f64; 3],
}

impl Moving {
    /// Number of values.
    pub(crate) const SIZE: usize = 12;
    /// Place of the position among them.
    pub(crate) const POSITION: usize = 0;

    pub(crate) fn from_values(values: &[f64; Self::SIZE]) -> Self {
        let [position, velocity, m0, m1, m2, m3, m4, m5, feedback, e0, e1, e2] = *values;
        Self { position, velocity, measured: [m0, m1, m2, m3, m4, m5], feedback, estimate: [e0, e1, e2] }
    }

    pub(crate) fn values(&self) -> [f64; Self::SIZE] {
        let ([m0, m1, m2, m3, m4, m5], [e0, e1, e2]) = (self.measured, self.estimate);
        [self.position, self.velocity, m0, m1, m2, m3, m4, m5, self.feedback, e0, e1, e2]
    }
}

impl<const K: usize> MovingAxis<K> {
    /// Under this law, from m and m/s to m/s².
    pub(crate) fn new(configuration: &Configuration, design: &CascadeDesign, law: LinearLaw<K>) -> Self {
        Self {
            law,
            output_feedback: configuration.sensors.output_feedback,
            estimator: design.estimator.translation,
        }
    }

    /// A sample of the axis's controller, with errors of the measured position and velocity, and the acceleration that the thrust
    /// makes and what of its derivatives the law goes by, m/s², m/s³, m/s⁴, beside the estimated snap that nobody asked for, m/s⁴.
    pub(crate) fn sample(
        &self,
        state: &mut Moving,
        event: &LoopEvent,
        noise: [f64; 2],
        achieved: [f64; 4],
        unasked: f64,
    ) {
        let [position, velocity, disturbance] = state.estimate;
        let seen = if self.output_feedback {
            [position - velocity * event.early_s, velocity]
        } else {
            [state.position + noise[0], state.velocity + noise[1]]
        };
        let seen = [seen[0], seen[1], achieved[0], achieved[1], achieved[2], achieved[3]];
        let disturbing = [0.0, 0.0, disturbance, 0.0, unasked, unasked];
        state.feedback = self.law.feedback(&ChannelSample {
            increment: core::array::from_fn(|place| seen[place] - state.measured[place]),
            // What disturbs the vehicle accelerates it, too.
            deviation: core::array::from_fn(|place| seen[place] + disturbing[place]),
            held: state.feedback,
            disturbance,
        });
        state.measured = seen;
    }

    /// The estimator's step to the next sample of the attitude controller: by the acceleration that it models, m/s², and the error of the measured position, m.
    pub(crate) fn predict(&self, state: &mut Moving, modelled: f64, noise: f64) {
        let measured = state.position + noise;
        state.estimate =
            self.estimator.predict(&state.estimate.into(), &[modelled].into(), &[measured].into()).into();
    }
}
