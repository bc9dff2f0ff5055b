//! The motion that leads to a state, and the disturbance behind it.

use alloc::vec; // used by dmatrix!

use lmpc::{DesignError, Discretization, StateSpace};
use nalgebra::{DMatrix, SMatrix, SVector, dmatrix};
use serde::{Deserialize, Serialize};

use crate::finite::are_finite;

/// A disturbance that is found at once lasts when it has done so for about as long, s. Until then feedback answers it, and limits do not go by it: to
/// a plan that took a force that swings to last, the swings to one side would leave no room.
pub(crate) const LASTING_S: f64 = 0.12;

/// A model of N states and P inputs, channel by channel: the output, its rate, and others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MotionModel<const N: usize, const P: usize> {
    /// A.
    transition: SMatrix<f64, N, N>,
    /// A⁻¹.
    inverse: SMatrix<f64, N, N>,
    /// B.
    by_input: SMatrix<f64, N, P>,
    /// E: what an acceleration of each output does in a sample, against its drag: without drag \[ΔT²/2 ΔT 0 …\].
    by_disturbance: SMatrix<f64, N, P>,
    sample_time_s: f64,
}

impl<const N: usize, const P: usize> MotionModel<N, P> {
    /// Of a plant whose outputs have drags per mass, 1/s.
    ///
    /// # Errors
    /// [`DesignError::NotFinite`] when A cannot be inverted, [`DesignError::SampleTime`] unless the sample time is positive.
    pub(crate) fn new(
        plant: &StateSpace,
        drag_1_s: &SVector<f64, P>,
        sample_time_s: f64,
    ) -> Result<Self, DesignError> {
        let fixed = |matrix: &DMatrix<f64>| SMatrix::from_fn(|row, column| matrix[(row, column)]);
        let inverse = plant.a().clone().try_inverse().ok_or(DesignError::NotFinite { name: "A⁻¹" })?;
        let mut by_disturbance = SMatrix::zeros();
        for channel in 0..P {
            // Together with the acceleration of the model that stands against it, it must leave exactly nothing.
            let body = StateSpace::from_continuous(
                &dmatrix![0.0, 1.0; 0.0, -drag_1_s[channel]],
                &dmatrix![0.0; 1.0],
                &dmatrix![1.0, 0.0],
                sample_time_s,
                Discretization::ZeroOrderHold,
            )?;
            for (derivative, moved) in body.b().iter().enumerate() {
                by_disturbance[(N / P * channel + derivative, channel)] = *moved;
            }
        }
        Ok(Self {
            transition: fixed(plant.a()),
            inverse: fixed(&inverse),
            by_input: SMatrix::from_fn(|row, column| plant.b()[(row, column)]),
            by_disturbance,
            sample_time_s,
        })
    }
}

impl<const N: usize, const P: usize> MotionModel<N, P> {
    /// That of the first channel alone, of K = N/P states.
    pub(crate) fn first_channel<const K: usize>(&self) -> MotionModel<K, 1> {
        MotionModel {
            transition: self.transition.fixed_view::<K, K>(0, 0).into_owned(),
            inverse: self.inverse.fixed_view::<K, K>(0, 0).into_owned(),
            by_input: self.by_input.fixed_view::<K, 1>(0, 0).into_owned(),
            by_disturbance: self.by_disturbance.fixed_view::<K, 1>(0, 0).into_owned(),
            sample_time_s: self.sample_time_s,
        }
    }

    /// The feedback v(k−1) that a law −K Δx would have applied last, had it brought the vehicle from rest to this deviation without
    /// disturbances. `answer` gives −K Δx.
    ///
    /// ```text
    /// v = −K A⁻¹ (x − B v)
    /// ```
    fn feedback_before(
        &self,
        answer: impl Fn(&SVector<f64, N>) -> SVector<f64, P>,
        deviation: &SVector<f64, N>,
    ) -> SVector<f64, P> {
        let answer = |state: SVector<f64, N>| -> SVector<f64, P> { answer(&(self.inverse * state)) };
        let by_input = |channel: usize| answer(self.by_input.column(channel).into_owned());
        let identity = SMatrix::<f64, P, P>::identity();
        let by_feedback = identity + SMatrix::from_fn(|row, column| by_input(column)[row]);
        by_feedback.try_inverse().map_or_else(SVector::zeros, |inverse| inverse * answer(*deviation))
    }
}

/// What is known of the motion at the last sample.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct ObservedMotion<const N: usize, const P: usize> {
    /// x(k−1) − x_r(k−1); `None` before the first sample.
    deviation: Option<SVector<f64, N>>,
    /// d, accelerations that the model does not explain.
    disturbance: SVector<f64, P>,
    /// What of it has lasted.
    lasting: SVector<f64, P>,
}

impl<const N: usize, const P: usize> Default for ObservedMotion<N, P> {
    fn default() -> Self {
        Self { deviation: None, disturbance: SVector::zeros(), lasting: SVector::zeros() }
    }
}

/// What is seen of the motion at a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MotionSample<const N: usize, const P: usize> {
    /// x(k) − x_r(k).
    pub(crate) deviation: SVector<f64, N>,
    /// By how much the state has changed since the last sample beside the reference's own motion.
    pub(crate) change: SVector<f64, N>,
    /// v(k−1).
    pub(crate) feedback: SVector<f64, P>,
    /// w, by how much the reference's own derivatives have jumped.
    pub(crate) jump: SVector<f64, N>,
}

impl<const N: usize, const P: usize> ObservedMotion<N, P> {
    /// With a deviation at the last sample and a disturbance.
    pub(crate) fn new(deviation: SVector<f64, N>, disturbance: SVector<f64, P>) -> Self {
        Self { deviation: Some(deviation), disturbance, lasting: disturbance }
    }

    /// What a law that goes by a model begins with where it takes over a vehicle that moves beside its reference: the feedback by which it
    /// would have damped that so far. `None` without a model, and once a sample has been seen.
    pub(crate) fn first_feedback(
        &self,
        model: Option<&MotionModel<N, P>>,
        answer: impl Fn(&SVector<f64, N>) -> SVector<f64, P>,
        deviation: &SVector<f64, N>,
    ) -> Option<SVector<f64, P>> {
        let model = model.filter(|_| !self.has_begun())?;
        let mut moving = *deviation;
        for channel in 0..P {
            moving[N / P * channel] = 0.0;
        }
        Some(model.feedback_before(answer, &moving))
    }

    /// Whether a sample has been seen.
    pub(crate) fn has_begun(&self) -> bool {
        self.deviation.is_some()
    }

    /// d.
    pub(crate) fn disturbance(&self) -> SVector<f64, P> {
        self.disturbance
    }

    /// The increment Δx(k) that a law goes by: of the motion that leads to the deviation, or as it was measured when there is no model. What of
    /// it limits go by, and what passes: that of a disturbance which has not lasted for as long as a lag, s. Without a lag or a model nothing does.
    pub(crate) fn step(
        &mut self,
        model: Option<&MotionModel<N, P>>,
        seen: &MotionSample<N, P>,
        (sample_time_s, lag_s): (f64, f64),
    ) -> [SVector<f64, N>; 2] {
        let increment = match model {
            Some(model) => self.increment(model, seen),
            None => {
                self.watch(seen, sample_time_s);
                seen.change
            }
        };
        if lag_s > 0.0 {
            self.lasting += (self.disturbance - self.lasting) * -libm::expm1(-sample_time_s / lag_s);
        } else {
            self.lasting = self.disturbance;
        }
        let passing = model.map_or_else(SVector::zeros, |model| self.passing(model));
        [increment - passing, passing]
    }

    /// A sample of a law that goes by measured increments, which another one may take over from: notes the deviation, and finds the
    /// disturbance without a model, as far as the accelerations at both ends of the sample do not explain how the rate has changed.
    fn watch(&mut self, MotionSample { deviation, change, .. }: &MotionSample<N, P>, sample_time_s: f64) {
        let Some(before) = self.deviation.replace(*deviation) else { return };
        for channel in 0..P {
            let [rate, acceleration] = [1, 2].map(|derivative| N / P * channel + derivative);
            let explained = (deviation[acceleration] + before[acceleration]) / 2.0;
            let missed = change[rate] / sample_time_s - explained - self.disturbance[channel];
            if missed.is_finite() {
                self.disturbance[channel] += missed;
            }
        }
    }

    /// Goes on under another belief in what moves the vehicle: the last state counts as having so much more of some derivatives, and
    /// what an acceleration explains more, d explains less. The motion itself is what it was. Before the first sample nothing is known
    /// of it.
    pub(crate) fn believe(&mut self, more: &SVector<f64, N>) {
        let Some(deviation) = self.deviation else { return };
        let believed = deviation + more;
        let less: SVector<f64, P> = SVector::from_fn(|channel, _| more[N / P * channel + 2]);
        let (disturbance, lasting) = (self.disturbance - less, self.lasting - less);
        if are_finite(believed.as_slice()) && are_finite(disturbance.as_slice()) {
            *self = Self { deviation: Some(believed), disturbance, lasting };
        }
    }

    /// What of the last increment comes from a disturbance that has not lasted: A⁻¹ E (d − d̄), d̄ following d with the lag. Under noise,
    /// nobody knows it for a force sooner.
    fn passing(&self, model: &MotionModel<N, P>) -> SVector<f64, N> {
        model.inverse * model.by_disturbance * (self.disturbance - self.lasting)
    }

    /// The increment Δx(k) of the motion that leads to the deviation. At the first sample, d stays as it is:
    ///
    /// ```text
    /// ν    = Δẏ − [(A − I) x(k−1) + B v + E d]_ẏ        what the model has missed
    /// d    ← d + ν/ΔT
    /// Δx   = x − A⁻¹ (x + w − B v − E d)
    /// ```
    pub(crate) fn increment(
        &mut self,
        model: &MotionModel<N, P>,
        MotionSample { deviation, change, feedback, jump }: &MotionSample<N, P>,
    ) -> SVector<f64, N> {
        let driven = model.by_input * feedback;
        if let Some(before) = self.deviation.replace(*deviation) {
            let expected =
                model.transition * before - before + driven + model.by_disturbance * self.disturbance;
            for channel in 0..P {
                let rate = N / P * channel + 1;
                let missed = (change[rate] - expected[rate]) / model.sample_time_s;
                if missed.is_finite() {
                    self.disturbance[channel] += missed;
                }
            }
        }
        deviation - model.inverse * (deviation + jump - driven - model.by_disturbance * self.disturbance)
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec; // used by dmatrix!

    use lmpc::{Discretization, StateSpace};
    use nalgebra::{Matrix1x3, Vector1, Vector3, dmatrix};

    use super::{MotionModel, MotionSample, ObservedMotion};

    const SAMPLE_TIME_S: f64 = 0.05;

    /// z̈ = a, which follows its command with a lag of 30 ms.
    fn model() -> MotionModel<3, 1> {
        let plant = StateSpace::from_continuous(
            &dmatrix![0.0, 1.0, 0.0; 0.0, 0.0, 1.0; 0.0, 0.0, -1.0 / 0.03],
            &dmatrix![0.0; 0.0; 1.0 / 0.03],
            &dmatrix![1.0, 0.0, 0.0],
            SAMPLE_TIME_S,
            Discretization::ZeroOrderHold,
        );
        MotionModel::new(&plant.expect("a plant"), &Vector1::zeros(), SAMPLE_TIME_S).expect("a model")
    }

    /// v(k) = −K x(k) flown from a throw: at each sample, the one before is found from the present state alone.
    #[test]
    fn the_feedback_before_is_the_one_that_was_flown() {
        let model = model();
        let gain = Matrix1x3::new(6.0, 4.5, 0.2);
        let mut state = Vector3::new(0.3, -1.2, 2.0);
        for _ in 0..40 {
            let flown = -gain * state;
            state = model.transition * state + model.by_input * flown;
            let found = model.feedback_before(|increment| -gain * increment, &state);
            assert!((found - flown).norm() < 1e-9, "{found} {flown}");
        }
    }

    /// A vehicle that is under way at the first sample has not been pushed; one that was has been.
    #[test]
    fn motion_at_the_first_sample_is_no_disturbance() {
        let model = model();
        let mut observed = ObservedMotion::default();
        let seen = |deviation: Vector3<f64>, before: Vector3<f64>| MotionSample {
            deviation,
            change: deviation - before,
            feedback: Vector1::zeros(),
            jump: Vector3::zeros(),
        };
        let times = (SAMPLE_TIME_S, 0.0);
        let begins = |observed: &ObservedMotion<3, 1>| {
            observed.first_feedback(Some(&model), |_| Vector1::zeros(), &Vector3::zeros()).is_some()
        };
        assert!(begins(&observed));
        // Another mass says nothing of a motion that nobody has seen.
        observed.believe(&Vector3::new(0.0, 0.0, 1.0));
        let start = Vector3::new(0.0, 0.7, 0.0);
        let [increment, _] = observed.step(Some(&model), &seen(start, Vector3::zeros()), times);
        assert!(!begins(&observed) && observed.disturbance() == Vector1::zeros());
        assert!((increment - Vector3::new(0.7 * SAMPLE_TIME_S, 0.0, 0.0)).norm() < 1e-12, "{increment}");
        // 2 m/s² for a sample.
        let pushed =
            start + Vector3::new(0.7 * SAMPLE_TIME_S + SAMPLE_TIME_S.powi(2), 2.0 * SAMPLE_TIME_S, 0.0);
        let [increment, _] = observed.step(Some(&model), &seen(pushed, start), times);
        assert!((observed.disturbance().x - 2.0).abs() < 1e-12);
        assert!((increment - (pushed - start)).norm() < 1e-12, "{increment}");
    }
}
