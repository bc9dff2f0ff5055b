//! Limits that a controller keeps.

use lmpc::Quantity;
use nalgebra::DMatrix;
use pyo3::prelude::*;

use crate::arrays::matrix;
use crate::errors::ArgumentError;
use crate::whole::Whole;

/// directions · quantity ≤ upper at some future samples.
#[pyclass(frozen, from_py_object, module = "lmpc_quadrotor.control")]
#[derive(Clone)]
pub struct Limit(pub lmpc::Limit);

fn quantity_of(name: &str) -> PyResult<Quantity> {
    match name {
        "increment" => Ok(Quantity::Increment),
        "input" => Ok(Quantity::Input),
        "state" => Ok(Quantity::State),
        other => Err(ArgumentError::new_err(format!(
            "quantity = {other:?}; allowed are 'increment', 'input' and 'state'"
        ))),
    }
}

#[pymethods]
impl Limit {
    #[new]
    #[pyo3(signature = (quantity, directions, samples, soft = false))]
    fn new(quantity: &str, directions: &Bound<'_, PyAny>, samples: Vec<Whole>, soft: bool) -> PyResult<Self> {
        let directions = matrix("directions", directions)?;
        let samples = Whole::all(samples);
        Ok(Self(lmpc::Limit { quantity: quantity_of(quantity)?, directions, samples, soft }))
    }

    #[staticmethod]
    #[pyo3(signature = (quantity, count, samples, soft = false))]
    fn range(quantity: &str, count: Whole, samples: Vec<Whole>, soft: bool) -> PyResult<Self> {
        let limit = lmpc::Limit::range(quantity_of(quantity)?, count.0, Whole::all(samples));
        Ok(Self(lmpc::Limit { soft, ..limit }))
    }

    #[staticmethod]
    #[pyo3(signature = (quantity, sides, samples, soft = false))]
    fn polygon(quantity: &str, sides: Whole, samples: Vec<Whole>, soft: bool) -> PyResult<Self> {
        let limit = lmpc::Limit::polygon(quantity_of(quantity)?, sides.0, Whole::all(samples));
        Ok(Self(lmpc::Limit { soft, ..limit }))
    }

    /// How many values of `upper` it takes.
    #[getter]
    fn bounds(&self) -> usize {
        self.0.directions.nrows()
    }
}

/// directions · (C x + D u) ≤ upper at some future samples.
#[pyclass(frozen, from_py_object, module = "lmpc_quadrotor.control")]
#[derive(Clone)]
pub struct SignalLimit(pub lmpc::SignalLimit);

#[pymethods]
impl SignalLimit {
    #[new]
    #[pyo3(signature = (c, d, directions, samples, relaxation))]
    fn new(
        c: &Bound<'_, PyAny>,
        d: &Bound<'_, PyAny>,
        directions: &Bound<'_, PyAny>,
        samples: Vec<Whole>,
        relaxation: f64,
    ) -> PyResult<Self> {
        if !(relaxation > 0.0 && relaxation.is_finite()) {
            return Err(ArgumentError::new_err(format!("relaxation = {relaxation} is outside (0, ∞)")));
        }
        let (state, input, directions) =
            (matrix("c", c)?, matrix("d", d)?, matrix("directions", directions)?);
        Ok(Self(lmpc::SignalLimit { state, input, directions, samples: Whole::all(samples), relaxation }))
    }

    /// Upper and lower bounds of the inputs of a plant with so many states.
    #[staticmethod]
    fn input_range(states: Whole, inputs: Whole, samples: Vec<Whole>, relaxation: f64) -> PyResult<Self> {
        let directions = lmpc::SignalLimit::range(inputs.0);
        let limit = lmpc::SignalLimit::of_inputs(states.0, inputs.0, directions, Whole::all(samples));
        Self::giving_way(limit, relaxation)
    }

    /// Upper and lower bounds of some states, by their indices.
    #[staticmethod]
    fn state_range(
        states: Whole,
        inputs: Whole,
        limited: Vec<Whole>,
        samples: Vec<Whole>,
        relaxation: f64,
    ) -> PyResult<Self> {
        let (Whole(states), Whole(inputs), limited) = (states, inputs, Whole::all(limited));
        if let Some(index) = limited.iter().find(|index| **index >= states) {
            return Err(ArgumentError::new_err(format!(
                "limited has the index {index}; allowed are 0 to {}",
                states.saturating_sub(1)
            )));
        }
        let directions: DMatrix<f64> = lmpc::SignalLimit::range(limited.len());
        let limit = lmpc::SignalLimit::of_states(states, inputs, &limited, directions, Whole::all(samples));
        Self::giving_way(limit, relaxation)
    }

    /// How many values of `upper` it takes.
    #[getter]
    fn bounds(&self) -> usize {
        self.0.directions.nrows()
    }
}

impl SignalLimit {
    fn giving_way(limit: lmpc::SignalLimit, relaxation: f64) -> PyResult<Self> {
        if relaxation > 0.0 && relaxation.is_finite() {
            Ok(Self(limit.giving_way_by(relaxation)))
        } else {
            Err(ArgumentError::new_err(format!("relaxation = {relaxation} is outside (0, ∞)")))
        }
    }
}
