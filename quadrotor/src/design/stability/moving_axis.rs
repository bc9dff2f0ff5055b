//! One axis of the position under its controller, for small signals.

use nalgebra::SVector;

use crate::control::observed_motion::{MotionModel, MotionSample, ObservedMotion};
use crate::design::axis_predictor::AxisPredictor;
use crate::design::stability::linear_law::{ChannelSample, LinearLaw};
use crate::design::stability::loop_events::LoopEvent;
use crate::{CascadeDesign, Configuration};

/// Place of the snap among the derivatives of a position; a law of the altitude does not go by it.
const SNAP: usize = 4;

/// One axis of translation: what its controller and the estimator do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MovingAxis<const K: usize> {
    /// From positions to accelerations.
    law: LinearLaw<K>,
    motion: Option<MotionModel<K, 1>>,
    /// Whether the law goes by the estimate of position and velocity.
    estimated: bool,
    estimator: AxisPredictor,
    /// Whether a change of what turns the body is surely one: noise hides small ones.
    is_sure: bool,
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
    /// The acceleration that the controller has found unexplained, m/s².
    found: f64,
    /// Position, velocity and unexplained acceleration.
    estimate: [f64; 3],
    /// The snap that nobody asked for, at the last sample, m/s⁴.
    unasked: f64,
}

impl Moving {
    /// Number of values.
    pub(crate) const SIZE: usize = 14;
    /// Place of the position among them.
    pub(crate) const POSITION: usize = 0;

    pub(crate) fn from_values(values: &[f64; Self::SIZE]) -> Self {
        let [position, velocity, m0, m1, m2, m3, m4, m5, feedback, found, e0, e1, e2, unasked] = *values;
        Self {
            position,
            velocity,
            measured: [m0, m1, m2, m3, m4, m5],
            feedback,
            found,
            estimate: [e0, e1, e2],
            unasked,
        }
    }

    pub(crate) fn values(&self) -> [f64; Self::SIZE] {
        let ([m0, m1, m2, m3, m4, m5], [e0, e1, e2]) = (self.measured, self.estimate);
        [
            self.position,
            self.velocity,
            m0,
            m1,
            m2,
            m3,
            m4,
            m5,
            self.feedback,
            self.found,
            e0,
            e1,
            e2,
            self.unasked,
        ]
    }
}

impl<const K: usize> MovingAxis<K> {
    /// Under this law, from m and m/s to m/s².
    pub(crate) fn new(
        configuration: &Configuration,
        design: &CascadeDesign,
        (law, motion): (LinearLaw<K>, Option<MotionModel<K, 1>>),
    ) -> Self {
        Self {
            law,
            motion,
            estimated: configuration.sensors.estimates_motion(),
            estimator: design.estimator.translation,
            is_sure: design.estimator.unsure_rad_s2.xy().max() == 0.0,
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
        let seen = if self.estimated {
            [position - velocity * event.early_s, velocity]
        } else {
            [state.position + noise[0], state.velocity + noise[1]]
        };
        // By a model, it is moved by what turns the body, the torques that nobody asked for among them.
        let turned = if self.motion.is_some() { unasked } else { 0.0 };
        let seen = [seen[0], seen[1], achieved[0], achieved[1], achieved[2] + turned, achieved[3] + turned];
        let deviation: [f64; K] = core::array::from_fn(|place| seen[place]);
        let before: [f64; K] = core::array::from_fn(|place| state.measured[place]);
        let change = SVector::from(deviation) - SVector::from(before);
        let increment = match &self.motion {
            Some(model) => {
                let mut observed = ObservedMotion::new(before.into(), [state.found].into());
                let seen = MotionSample {
                    deviation: deviation.into(),
                    change,
                    feedback: [state.feedback].into(),
                    jump: SVector::zeros(),
                };
                let mut increment = observed.increment(model, &seen);
                if self.is_sure && K > SNAP {
                    increment[SNAP] += turned - state.unasked;
                }
                state.found = observed.disturbance()[0];
                increment
            }
            None => {
                // Nothing is found by measured increments.
                state.found = 0.0;
                change
            }
        };
        let left = unasked - turned;
        let disturbing = [0.0, 0.0, disturbance, 0.0, left, left];
        state.feedback = self.law.feedback(&ChannelSample {
            increment: increment.into(),
            // What disturbs the vehicle accelerates it, too.
            deviation: core::array::from_fn(|place| seen[place] + disturbing[place]),
            held: state.feedback,
            disturbance,
        });
        state.measured = seen;
        state.unasked = turned;
    }

    /// The estimator's step to the next sample of the attitude controller: by the acceleration that it models, m/s², and the
    /// errors of the measured position and velocity, m, m/s.
    pub(crate) fn predict(&self, state: &mut Moving, modelled: f64, noise: [f64; 2]) {
        let measured = [state.position + noise[0], state.velocity + noise[1]];
        state.estimate = self.estimator.predict(&state.estimate, modelled, measured).into();
    }
}
