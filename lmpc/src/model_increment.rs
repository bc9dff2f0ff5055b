//! The increment of the state that a model explains.

use nalgebra::{DMatrix, SMatrix, SVector};
use serde::{Deserialize, Serialize};

use crate::precision::converted;
use crate::{DesignError, Precision, StateSpace, validate};

/// The motion Δx which, by a model, leads to a state x under a driving input u: x − A⁻¹(x − B u).
///
/// Given to an incremental law as its increment, with the input v(k−1) + d(k) that drives the deviation from the reference, it makes
/// the law one of the deviation. Gain and eigenvalues stay the same. What differs is a jump of the reference, which moves x at
/// once but is no motion of the past that the integral action would have to undo, and an actuator that answers late, which looks
/// like a disturbance in the measured motion. The integral action is then the estimated disturbance d.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "T: Precision")]
pub struct ModelIncrement<const N: usize, const P: usize, T = f64> {
    /// I − A⁻¹
    by_state: SMatrix<T, N, N>,
    /// A⁻¹ B
    by_input: SMatrix<T, N, P>,
}

impl<const N: usize, const P: usize> ModelIncrement<N, P> {
    /// For a plant of N states and P inputs whose A can be inverted.
    ///
    /// # Errors
    /// [`DesignError::Dimension`] when the sizes differ from the const generics, [`DesignError::NotFinite`] when A cannot be
    /// inverted.
    pub fn new(plant: &StateSpace) -> Result<Self, DesignError> {
        validate::shape("A", plant.a(), (N, N))?;
        validate::shape("B", plant.b(), (N, P))?;
        let inverse = plant.a().clone().try_inverse().ok_or(DesignError::NotFinite { name: "A⁻¹" })?;
        let by_input = &inverse * plant.b();
        let by_state = DMatrix::identity(N, N) - inverse;
        Ok(Self {
            by_state: SMatrix::from_fn(|i, j| by_state[(i, j)]),
            by_input: SMatrix::from_fn(|i, j| by_input[(i, j)]),
        })
    }
}

impl<const N: usize, const P: usize, T: Precision> ModelIncrement<N, P, T> {
    /// The same model in another precision.
    pub fn to_precision<U: Precision>(&self) -> ModelIncrement<N, P, U> {
        ModelIncrement { by_state: converted(&self.by_state), by_input: converted(&self.by_input) }
    }

    /// Δx(k) of the state x(k), under the input u(k−1).
    pub fn that_led_to(&self, state: &SVector<T, N>, driving: &SVector<T, P>) -> SVector<T, N> {
        self.by_state * state + self.by_input * driving
    }
}
