//! What a controller is told at one sample.

use nalgebra::{SMatrix, SVector};
use serde::{Deserialize, Serialize};

use crate::Precision;

/// What a controller is told at sample k, with N states, P inputs and Q outputs. Which fields a law reads stands at
/// [`Controller`](crate::Controller); what is left at its default is zero, and no limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<'a, const N: usize, const P: usize, const Q: usize, T = f64> {
    /// x(k), the state, measured or estimated.
    pub measured: SVector<T, N>,
    /// Δx(k) = x(k) − x(k−1) − Δx_r(k), the motion that the reference does not explain.
    pub increment: SVector<T, N>,
    /// x(k) − x_r(k), the deviation from the reference trajectory.
    pub deviation: SVector<T, N>,
    /// y(k) − r(k), the output error.
    pub error: SVector<T, Q>,
    /// u_r(k), the input that keeps the plant on the reference trajectory (feed-forward).
    pub input_reference: SVector<T, P>,
    /// d(k), an estimated disturbance that acts on the plant as if it were added to the input, taken to last.
    pub disturbance: SVector<T, P>,
    /// The value of each bound: one per direction of each [`Limit`](crate::Limit), in their order. Those that are
    /// missing do not bound.
    pub upper: &'a [T],
    /// By how much the reference's own motion moves each limited signal until its sample: C (x_r(k+m) − x_r(k)) +
    /// D (u_r(k+m) − u_r(k)), limit by limit, component by component, sample by sample. What is missing is zero.
    pub moved: &'a [T],
    /// r(k), r(k+1), … as deviations from the reference trajectory, as far as they are known; the last one lasts.
    pub preview: &'a [SVector<T, Q>],
}

impl<const N: usize, const P: usize, const Q: usize, T: Precision> Default for Sample<'_, N, P, Q, T> {
    fn default() -> Self {
        Self {
            measured: SVector::zeros(),
            increment: SVector::zeros(),
            deviation: SVector::zeros(),
            error: SVector::zeros(),
            input_reference: SVector::zeros(),
            disturbance: SVector::zeros(),
            upper: &[],
            moved: &[],
            preview: &[],
        }
    }
}

/// What the plant is asked to do at one sample, with N states and P inputs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "T: Precision")]
pub struct Reference<const N: usize, const P: usize, T = f64> {
    /// x_r(k), the reference state.
    pub state: SVector<T, N>,
    /// What a plant that follows the reference moves by from sample k−1 to k. Zero for a set-point: a
    /// jump of the set-point itself is *not* part of it, so that it enters through y − r alone.
    pub increment: SVector<T, N>,
    /// u_r(k), the input that keeps the plant on the reference (feed-forward).
    pub input: SVector<T, P>,
}

impl<const N: usize, const P: usize, T: Precision> Reference<N, P, T> {
    /// A state to go to and stay at, with the input that holds it there.
    pub fn set_point(state: SVector<T, N>, input: SVector<T, P>) -> Self {
        Self { state, increment: SVector::zeros(), input }
    }

    /// The sample of a plant with the output matrix C, Q×N, whose state was x(k−1) = `previous` and is
    /// x(k) = `measured`. Without bounds, disturbance and preview.
    pub fn sample<const Q: usize>(
        &self,
        output: &SMatrix<T, Q, N>,
        previous: &SVector<T, N>,
        measured: &SVector<T, N>,
    ) -> Sample<'static, N, P, Q, T> {
        let deviation = measured - self.state;
        Sample {
            measured: *measured,
            increment: measured - previous - self.increment,
            deviation,
            error: output * deviation,
            input_reference: self.input,
            ..Sample::default()
        }
    }
}
