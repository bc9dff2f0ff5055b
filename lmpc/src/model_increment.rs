//! The increment of the state that a model explains.

use nalgebra::{DMatrix, SMatrix, SVector};

use crate::{DesignError, StateSpace, validate};

/// Δx that leads to a state under a driving input: x − A⁻¹(x − B u). Under limits it stands for the measured
/// motion, in which an actuator that answers late looks like a disturbance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ModelIncrement<const N: usize, const P: usize> {
    /// I − A⁻¹
    by_state: SMatrix<f64, N, N>,
    /// A⁻¹ B
    by_input: SMatrix<f64, N, P>,
}

impl<const N: usize, const P: usize> ModelIncrement<N, P> {
    /// For a plant of N states and P inputs whose A can be inverted.
    pub(crate) fn new(plant: &StateSpace) -> Result<Self, DesignError> {
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

    /// Δx(k) of the state x(k), under the input u(k−1).
    pub(crate) fn that_led_to(&self, state: &SVector<f64, N>, driving: &SVector<f64, P>) -> SVector<f64, N> {
        self.by_state * state + self.by_input * driving
    }
}
