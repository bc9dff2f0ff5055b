//! Discrete Laguerre functions.

use nalgebra::DMatrix;
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::arguments::{MOST, MOST_SAMPLES, number, whole};
use crate::arrays::{array1, array2};
use crate::errors;

/// N = `terms` discrete Laguerre functions, 1 to 1000, with the scaling factor a = `scale`, 0 ≤ a < 1; a = 0 are unit pulses.
#[pyclass(frozen, module = "lmpc_quadrotor.control")]
#[derive(Clone)]
pub struct LaguerreBasis(pub lmpc::LaguerreBasis);

#[pymethods]
impl LaguerreBasis {
    #[new]
    fn new(terms: &Bound<'_, PyAny>, scale: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (terms, scale) = (whole("terms", terms, 1..=MOST)?, number("scale", scale)?);
        lmpc::LaguerreBasis::new(terms, scale).map(Self).map_err(|refusal| errors::design(&refusal))
    }

    /// Functions that reach about `control_horizon` samples far: a = e^(−N/N_c).
    #[staticmethod]
    fn for_control_horizon(terms: &Bound<'_, PyAny>, control_horizon: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (terms, horizon) =
            (whole("terms", terms, 1..=MOST)?, number("control_horizon", control_horizon)?);
        let basis = lmpc::LaguerreBasis::for_control_horizon(terms, horizon);
        basis.map(Self).map_err(|refusal| errors::design(&refusal))
    }

    /// N.
    #[getter]
    fn terms(&self) -> usize {
        self.0.terms()
    }

    /// a.
    #[getter]
    fn scale(&self) -> f64 {
        self.0.scale()
    }

    /// A_l, N×N: L(k+1) = A_l L(k).
    #[getter]
    fn a_l<'py>(&self, python: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        array2(python, self.0.a_l())
    }

    /// L(0), N.
    #[getter]
    fn initial<'py>(&self, python: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array1(python, self.0.initial().as_slice())
    }

    /// L(0), L(1), … as rows: samples×N, 10 000 samples at most.
    fn functions<'py>(
        &self,
        python: Python<'py>,
        samples: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let samples = whole("samples", samples, 0..=MOST_SAMPLES)?;
        let mut functions = DMatrix::zeros(samples, self.0.terms());
        let mut l = self.0.initial().clone();
        for mut row in functions.row_iter_mut() {
            row.copy_from(&l.transpose());
            l = self.0.a_l() * l;
        }
        array2(python, &functions)
    }

    fn __repr__(&self) -> String {
        format!("LaguerreBasis(terms={}, scale={})", self.0.terms(), self.0.scale())
    }
}
