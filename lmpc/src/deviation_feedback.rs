//! State feedback by the deviation from the reference alone.

use nalgebra::DMatrix;

use crate::model_increment::ModelIncrement;
use crate::{Controller, ControllerState, DesignError, Sample, StateFeedback, StateSpace, Step};

/// [`StateFeedback`] that goes by the state instead of its measured increments, for a plant of N states, P inputs and Q
/// outputs:
///
/// ```text
/// Δx(k) = x(k) − A⁻¹ (x(k) − B (v(k−1) + d(k)))     motion that by the model leads to the deviation x = x(k) − x_r(k)
/// Δv(k) = −K_x Δx(k) − K_y (y(k) − r(k))
/// ```
///
/// The gain and the eigenvalues are those of the incremental law. What differs is a jump of the reference: it moves x at
/// once, but is no motion of the past that the integral action would have to undo. The integral action is the estimated
/// disturbance d, which each sample must tell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeviationFeedback<const N: usize, const P: usize, const Q: usize> {
    feedback: StateFeedback<N, P, Q>,
    increment: ModelIncrement<N, P>,
}

impl<const N: usize, const P: usize, const Q: usize> DeviationFeedback<N, P, Q> {
    /// From a plant and the gain K, P×(N+Q), for instance a [regulator's](crate::Dlqr::gain).
    ///
    /// # Errors
    /// [`DesignError::Dimension`] when the sizes differ from the const generics, [`DesignError::NotFinite`] when A of the
    /// plant cannot be inverted.
    pub fn new(plant: &StateSpace, gain: &DMatrix<f64>) -> Result<Self, DesignError> {
        Ok(Self { feedback: StateFeedback::new(gain)?, increment: ModelIncrement::new(plant)? })
    }
}

impl<const N: usize, const P: usize, const Q: usize, const W: usize> Controller<N, P, Q, W>
    for DeviationFeedback<N, P, Q>
{
    fn step(&self, state: &mut ControllerState<N, P, W>, sample: &Sample<'_, N, P, Q>) -> Step<P> {
        let driving = state.feedback() + sample.disturbance;
        let increment = self.increment.that_led_to(&sample.deviation, &driving);
        self.feedback.step(state, &Sample { increment, ..*sample })
    }
}
