//! The stationary Kalman predictor.

use lmpc::NoiseCovariance;
use nalgebra::{DMatrix, DVector};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use super::models::StateSpace;
use crate::arrays::{array1, array2, finite_vector_of, matrix, vector_of};
use crate::errors;

/// The covariances as the formulas call them, and as Python does.
const NAMES: [(&str, &str); 4] = [
    ("W", "state_noise"),
    ("V", "measurement_noise"),
    ("Z", "cross"),
    ("[W Z; Zᵀ V]", "state_noise, measurement_noise and cross together"),
];

/// The stationary predictor of x(k+1) = A x + B u + w, y = C x + v.
///
/// Covariances: `state_noise` of w, n×n; `measurement_noise` of v, q×q, positive definite; `cross` = E[w vᵀ], n×q.
#[pyclass(frozen, module = "lmpc_quadrotor.control")]
pub struct KalmanDesign {
    plant: lmpc::StateSpace,
    design: lmpc::KalmanDesign,
}

#[pymethods]
impl KalmanDesign {
    #[new]
    #[pyo3(signature = (plant, state_noise, measurement_noise, cross = None))]
    fn new(
        plant: &StateSpace,
        state_noise: &Bound<'_, PyAny>,
        measurement_noise: &Bound<'_, PyAny>,
        cross: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let (state, measurement) =
            (matrix("state_noise", state_noise)?, matrix("measurement_noise", measurement_noise)?);
        let noise = match cross {
            Some(cross) => NoiseCovariance { state, measurement, cross: matrix("cross", cross)? },
            None => NoiseCovariance::uncorrelated(state, measurement),
        };
        let design = lmpc::KalmanDesign::new(&plant.0, &noise);
        let design = design.map_err(|refusal| errors::design_of(&refusal, &NAMES))?;
        Ok(Self { plant: plant.0.clone(), design })
    }

    /// K, n×q.
    #[getter]
    fn gain<'py>(&self, python: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        array2(python, self.design.gain())
    }

    /// Covariance of the error of the prediction, n×n.
    #[getter]
    fn covariance<'py>(&self, python: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        array2(python, self.design.covariance())
    }
}

/// The predictor of a design at run time, from an estimate of n numbers on; zero if it is left out.
#[pyclass(module = "lmpc_quadrotor.control")]
pub struct KalmanPredictor {
    plant: lmpc::StateSpace,
    gain: DMatrix<f64>,
    estimate: DVector<f64>,
}

#[pymethods]
impl KalmanPredictor {
    #[new]
    #[pyo3(signature = (design, estimate = None))]
    fn new(design: &KalmanDesign, estimate: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let states = design.plant.states();
        Ok(Self {
            plant: design.plant.clone(),
            gain: design.design.gain().clone(),
            estimate: finite_vector_of("estimate", estimate, states)?,
        })
    }

    /// x̂ of the next sample, n.
    #[getter]
    fn estimate<'py>(&self, python: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array1(python, self.estimate.as_slice())
    }

    /// Goes on to the next sample, from u(k), p, and y(k), q; returns x̂(k+1), n. What is not finite is left out.
    fn predict<'py>(
        &mut self,
        python: Python<'py>,
        input: &Bound<'py, PyAny>,
        measurement: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let input = vector_of("input", Some(input), self.plant.inputs())?;
        let measurement = vector_of("measurement", Some(measurement), self.plant.outputs())?;
        // x̂(k+1|k) = A x̂(k|k−1) + B u(k) + K (y(k) − C x̂(k|k−1))
        let open_loop = self.plant.a() * &self.estimate + self.plant.b() * input;
        let innovation = measurement - self.plant.c() * &self.estimate;
        let corrected = &open_loop + &self.gain * innovation;
        let finite = |vector: &DVector<f64>| vector.iter().all(|value| value.is_finite());
        if let Some(next) = [corrected, open_loop].into_iter().find(finite) {
            self.estimate = next;
        }
        Ok(self.estimate(python))
    }
}
