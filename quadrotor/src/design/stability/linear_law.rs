//! What a controller does with small signals.

use lmpc::{ControllerState, Sample};
use nalgebra::SVector;

use crate::control::tracking_law::TrackingLaw;

/// The gains of one channel of C states, the first of which is its output, of a [`TrackingLaw`] without active limits, found
/// from its answers to unit signals: they are those of the code that flies, whatever the kind of controller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LinearLaw<const C: usize> {
    /// On the increments of the channel's states.
    increment: [f64; C],
    /// On their deviations.
    deviation: [f64; C],
    /// On the output error.
    error: f64,
    /// On the feedback of the sample before.
    held: f64,
    /// On the estimated disturbance.
    disturbance: f64,
}

/// What one channel of a controller is told at a sample: small signals about hover.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ChannelSample<const C: usize> {
    /// The channel's states since the sample before.
    pub(crate) increment: [f64; C],
    /// The channel's states less their references.
    pub(crate) deviation: [f64; C],
    /// Feedback of the sample before.
    pub(crate) held: f64,
    /// Estimated disturbance, in units of the input.
    pub(crate) disturbance: f64,
}

impl<const C: usize> LinearLaw<C> {
    /// Of each channel: the channels of a cascade's controller do not act on one another.
    pub(crate) fn of<const N: usize, const P: usize, const S: usize, const L: usize>(
        law: &TrackingLaw<N, P, S, L>,
    ) -> [Self; P] {
        let answer = |held: f64, sample: Sample<'_, N, P, P>| {
            let mut state =
                ControllerState::new(SVector::zeros(), SVector::repeat(held), SVector::zeros()).keeping();
            law.step(&mut state, &sample).input
        };
        // One channel's states after the other's.
        let unit = |place: usize| SVector::from_fn(|state, _| if state % C == place { 1.0 } else { 0.0 });
        let deviation = core::array::from_fn::<_, C, _>(|place| {
            answer(0.0, Sample { deviation: unit(place), ..Sample::default() })
        });
        let (increment, error) = if law.sees_deviation_alone() {
            ([SVector::zeros(); C], SVector::zeros())
        } else {
            (
                core::array::from_fn(|place| {
                    answer(0.0, Sample { increment: unit(place), ..Sample::default() })
                }),
                answer(0.0, Sample { error: SVector::repeat(1.0), ..Sample::default() }),
            )
        };
        let held = answer(1.0, Sample::default());
        let disturbance = answer(0.0, Sample { disturbance: SVector::repeat(1.0), ..Sample::default() });
        core::array::from_fn(|channel| Self {
            increment: increment.map(|input| input[channel]),
            deviation: deviation.map(|input| input[channel]),
            error: error[channel],
            held: held[channel],
            disturbance: disturbance[channel],
        })
    }

    /// The feedback of a sample.
    pub(crate) fn feedback(&self, sample: &ChannelSample<C>) -> f64 {
        let sum = |gains: &[f64; C], values: &[f64; C]| {
            gains.iter().zip(values).map(|(gain, value)| gain * value).sum::<f64>()
        };
        sum(&self.increment, &sample.increment)
            + sum(&self.deviation, &sample.deviation)
            + self.error * sample.deviation[0]
            + self.held * sample.held
            + self.disturbance * sample.disturbance
    }
}
