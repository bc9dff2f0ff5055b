//! Linear state feedback with integral action: the law of every design without limits.

use nalgebra::{DMatrix, SMatrix};
use serde::{Deserialize, Serialize};

use crate::controller_state::Decision;
use crate::precision::converted;
use crate::relaxable::RelaxableWarmStart;
use crate::{Controller, ControllerState, DesignError, LmpcDesign, Precision, Sample, Step, validate};

/// The unconstrained receding-horizon law Δu = −K \[Δx_m; y − r\] in incremental form, for a plant of N
/// states, P inputs and Q outputs: Laguerre MPC without limits, or the [regulator](crate::Dlqr).
///
/// ```text
/// Δe(k) = x(k) − x(k−1) − Δx_r(k)          motion that the reference does not explain
/// Δv(k) = −K_x Δe(k) − K_y (y(k) − r(k))
/// u(k)  = u_r(k) + v(k−1) + Δv(k)
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "T: Precision")]
pub struct StateFeedback<const N: usize, const P: usize, const Q: usize, T = f64> {
    state_gain: SMatrix<T, P, N>,
    output_gain: SMatrix<T, P, Q>,
}

impl<const N: usize, const P: usize, const Q: usize> StateFeedback<N, P, Q> {
    /// From the gain K, P×(N+Q), for instance a [regulator's](crate::Dlqr::gain).
    ///
    /// # Errors
    /// [`DesignError::Dimension`] when the sizes differ from the const generics,
    /// [`DesignError::ElementNotFinite`].
    pub fn new(gain: &DMatrix<f64>) -> Result<Self, DesignError> {
        validate::shape("K", gain, (P, N + Q))?;
        Ok(Self {
            state_gain: SMatrix::from_fn(|row, column| gain[(row, column)]),
            output_gain: SMatrix::from_fn(|row, column| gain[(row, N + column)]),
        })
    }

    /// The law of a Laguerre MPC design without limits.
    ///
    /// # Errors
    /// As [`StateFeedback::new`].
    pub fn from_design(design: &LmpcDesign) -> Result<Self, DesignError> {
        Self::new(design.gain())
    }
}

impl<const N: usize, const P: usize, const Q: usize, T: Precision> StateFeedback<N, P, Q, T> {
    /// The same law in another precision.
    pub fn to_precision<U: Precision>(&self) -> StateFeedback<N, P, Q, U> {
        StateFeedback { state_gain: converted(&self.state_gain), output_gain: converted(&self.output_gain) }
    }

    /// K_x, the part of the gain on Δx_m, P×N.
    pub fn state_gain(&self) -> &SMatrix<T, P, N> {
        &self.state_gain
    }

    /// K_y, the part of the gain on y − r, P×Q.
    pub fn output_gain(&self) -> &SMatrix<T, P, Q> {
        &self.output_gain
    }
}

impl<const N: usize, const P: usize, const Q: usize, const W: usize, T: Precision, const K: usize>
    Controller<N, P, Q, W, T, K> for StateFeedback<N, P, Q, T>
{
    fn step(
        &self,
        state: &mut ControllerState<N, P, W, T, K>,
        sample: &Sample<'_, N, P, Q, T>,
    ) -> Step<P, T> {
        let integral = -(self.output_gain * sample.error);
        let feedback = state.feedback() - self.state_gain * sample.increment + integral;
        state.warm_start = RelaxableWarmStart::default();
        state.take(sample, &Decision::linear(feedback, integral))
    }
}
