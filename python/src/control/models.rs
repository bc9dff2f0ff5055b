//! Linear plants.

use lmpc::{Augmented, Discretization};
use numpy::PyArray2;
use pyo3::prelude::*;

use crate::arguments::{above_zero, number, number_or};
use crate::arrays::{array2, matrix};
use crate::errors::{self, ArgumentError};

/// A discrete linear plant x(k+1) = A x(k) + B u(k), y(k) = C x(k), with A n×n, B n×p and C q×n.
///
/// Raises `DesignError` when the shapes do not fit or a number is not finite.
#[pyclass(frozen, module = "lmpc_quadrotor.control")]
pub struct StateSpace(pub lmpc::StateSpace);

#[pymethods]
impl StateSpace {
    #[new]
    fn new(a: &Bound<'_, PyAny>, b: &Bound<'_, PyAny>, c: &Bound<'_, PyAny>) -> PyResult<Self> {
        let plant = lmpc::StateSpace::new(matrix("a", a)?, matrix("b", b)?, matrix("c", c)?);
        plant.map(Self).map_err(|refusal| errors::design(&refusal))
    }

    /// From ẋ = A x + B u, y = C x, sampled every `sample_time` s, which must be positive.
    #[staticmethod]
    #[pyo3(signature = (a, b, c, sample_time, discretization = "zero_order_hold"))]
    fn from_continuous(
        a: &Bound<'_, PyAny>,
        b: &Bound<'_, PyAny>,
        c: &Bound<'_, PyAny>,
        sample_time: &Bound<'_, PyAny>,
        discretization: &str,
    ) -> PyResult<Self> {
        let discretization = match discretization {
            "zero_order_hold" => Discretization::ZeroOrderHold,
            "forward_euler" => Discretization::ForwardEuler,
            other => {
                return Err(ArgumentError::new_err(format!(
                    "discretization = {other:?}; allowed are 'zero_order_hold' and 'forward_euler'"
                )));
            }
        };
        let sample_time = number("sample_time", sample_time)?;
        let (a, b, c) = (matrix("a", a)?, matrix("b", b)?, matrix("c", c)?);
        let plant = lmpc::StateSpace::from_continuous(&a, &b, &c, sample_time, discretization);
        plant.map(Self).map_err(|refusal| errors::design(&refusal))
    }

    /// From A, B, C and D, q×p, of y(k) = C x(k) + D u(k−1). The states are [x(k); u(k−1)].
    #[staticmethod]
    fn with_direct_term(
        a: &Bound<'_, PyAny>,
        b: &Bound<'_, PyAny>,
        c: &Bound<'_, PyAny>,
        d: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let (a, b, c, d) = (matrix("a", a)?, matrix("b", b)?, matrix("c", c)?, matrix("d", d)?);
        let plant = lmpc::StateSpace::with_direct_term(&a, &b, &c, &d);
        plant.map(Self).map_err(|refusal| errors::design(&refusal))
    }

    /// A, n×n.
    #[getter]
    fn a<'py>(&self, python: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        array2(python, self.0.a())
    }

    /// B, n×p.
    #[getter]
    fn b<'py>(&self, python: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        array2(python, self.0.b())
    }

    /// C, q×n.
    #[getter]
    fn c<'py>(&self, python: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        array2(python, self.0.c())
    }

    /// n.
    #[getter]
    fn states(&self) -> usize {
        self.0.states()
    }

    /// p.
    #[getter]
    fn inputs(&self) -> usize {
        self.0.inputs()
    }

    /// q.
    #[getter]
    fn outputs(&self) -> usize {
        self.0.outputs()
    }

    /// A, (n+q)×(n+q), B, (n+q)×p, and C, q×(n+q), of the incremental model with the states [Δx; y − r].
    #[allow(clippy::type_complexity, reason = "three arrays, as Python takes them")]
    fn augmented<'py>(
        &self,
        python: Python<'py>,
    ) -> PyResult<(Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<f64>>)> {
        let model = Augmented::new(&self.0);
        Ok((array2(python, model.a())?, array2(python, model.b())?, array2(python, model.c())?))
    }

    /// Q = output · CᵀC, (n+q)×(n+q), and R = increment · I, p×p, of the incremental model.
    #[pyo3(signature = (output = None, increment = None), text_signature = "($self, output=1.0, increment=1.0)")]
    #[allow(clippy::type_complexity, reason = "two arrays, as Python takes them")]
    fn output_weights<'py>(
        &self,
        python: Python<'py>,
        output: Option<&Bound<'py, PyAny>>,
        increment: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<(Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<f64>>)> {
        let (output, increment) =
            (number_or("output", output, 1.0)?, number_or("increment", increment, 1.0)?);
        if !(output >= 0.0 && output.is_finite()) {
            return Err(ArgumentError::new_err(format!("output = {output} is outside [0, ∞)")));
        }
        let increment = above_zero("increment", increment)?;
        let weights = lmpc::Weights::output(&Augmented::new(&self.0), output, increment)
            .map_err(|refusal| errors::design(&refusal))?;
        Ok((array2(python, weights.q())?, array2(python, weights.r())?))
    }

    fn __repr__(&self) -> String {
        let plant = &self.0;
        format!(
            "StateSpace(states={}, inputs={}, outputs={})",
            plant.states(),
            plant.inputs(),
            plant.outputs()
        )
    }
}
