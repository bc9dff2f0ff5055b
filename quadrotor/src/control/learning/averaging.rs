//! How much the learner's averages take in and keep over an interval.

use nalgebra::SVector;

use crate::ControllerSettings;
use crate::control::learning::excitation::STEADY_S;
use crate::control::learning::mass_and_drag::{GUSTY_S, LEARNS_EACH_US, STEADY_FORCE_S};
use crate::control::learning::motion_equation::STAGE_S;
use crate::control::learning::prior_knowledge::{UNKNOWNS, memory_s};

/// Shares over an interval: what comes in, 1 − e^(−t/T), of averages, and what is kept, e^(−t/T), of what is remembered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Averaging {
    interval_s: f64,
    /// Into a stage of the filter of the equation of motion.
    pub(crate) stage: f64,
    /// Into what is steady of the motion.
    pub(crate) steady_motion: f64,
    /// Into what is steady of forces and thrust.
    pub(crate) steady_force: f64,
    /// Of gusts.
    pub(crate) gusts_kept: f64,
    /// Of what was learned of each number.
    pub(crate) learned_kept: SVector<f64, UNKNOWNS>,
}

impl Averaging {
    /// Over an interval, s.
    pub(crate) fn over(interval_s: f64) -> Self {
        let coming = |time_s: f64| -libm::expm1(-interval_s / time_s);
        Self {
            interval_s,
            stage: coming(STAGE_S),
            steady_motion: coming(STEADY_S),
            steady_force: coming(STEADY_FORCE_S),
            gusts_kept: kept(interval_s, GUSTY_S),
            learned_kept: memory_s().map(|memory_s| kept(interval_s, memory_s)),
        }
    }
}

fn kept(interval_s: f64, time_s: f64) -> f64 {
    libm::exp(-interval_s / time_s)
}

/// Shares over the intervals of the attitude controller's samples, which are known before a flight: they take exponentials.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SampledAveraging {
    /// From one sample to the next.
    sample: Averaging,
    /// From one sample that is learned from to the next.
    learning: Averaging,
}

impl SampledAveraging {
    /// For the samples of the attitude controller.
    pub(crate) fn new<const P: usize>(attitude: &ControllerSettings<P>) -> Self {
        let sample_us = attitude.sample_time_us.max(1);
        let learning_us = LEARNS_EACH_US.div_ceil(sample_us) * sample_us;
        let [sample, learning] = [sample_us, learning_us].map(|us| Averaging::over(us as f64 / 1e6));
        Self { sample, learning }
    }

    /// Over an interval, s; computed into `room` if it is neither of these.
    pub(crate) fn over<'a>(&'a self, interval_s: f64, room: &'a mut Option<Averaging>) -> &'a Averaging {
        match [&self.sample, &self.learning].into_iter().find(|known| known.interval_s == interval_s) {
            Some(known) => known,
            None => room.insert(Averaging::over(interval_s)),
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{Averaging, SampledAveraging};
    use crate::Configuration;

    proptest! {
        /// What is known before a flight is what is found in it, and two halves of an interval make the whole.
        #[test]
        fn an_interval_takes_what_its_parts_take(sample_us in 1_000..60_000_u64, other_s in 1e-6..2.0_f64) {
            let mut attitude = Configuration::default().controllers.attitude;
            attitude.sample_time_us = sample_us;
            let sampled = SampledAveraging::new(&attitude);
            for interval_s in [sample_us as f64 / 1e6, 0.02, 0.03, other_s] {
                let whole = Averaging::over(interval_s);
                let mut room = None;
                prop_assert_eq!(sampled.over(interval_s, &mut room), &whole);
                let known = [sampled.sample.interval_s, sampled.learning.interval_s];
                prop_assert_eq!(room.is_none(), known.contains(&interval_s));
                let half = Averaging::over(interval_s / 2.0);
                let twice = |share: f64| 1.0 - (1.0 - share) * (1.0 - share);
                prop_assert!((twice(half.stage) - whole.stage).abs() < 1e-12);
                prop_assert!((twice(half.steady_motion) - whole.steady_motion).abs() < 1e-12);
                prop_assert!((twice(half.steady_force) - whole.steady_force).abs() < 1e-12);
                prop_assert!((half.gusts_kept * half.gusts_kept - whole.gusts_kept).abs() < 1e-12);
                let kept = half.learned_kept.component_mul(&half.learned_kept);
                prop_assert!((kept - whole.learned_kept).amax() < 1e-12);
            }
        }
    }
}
