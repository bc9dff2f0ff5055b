//! Limits that a controller keeps.

use lmpc::Quantity;
use nalgebra::DMatrix;
use pyo3::prelude::*;

use crate::arguments::{MOST, MOST_SAMPLES, positive, whole, wholes};
use crate::arrays::{check_finite, matrix};
use crate::errors::ArgumentError;

/// Most components that the signal of a limit has.
const MOST_COMPONENTS: usize = 3;

/// directions · quantity ≤ upper on some samples of a plan, 0 to 10 000; the values `upper` are given at each step.
///
/// `quantity` is "increment" (Δu), "input" (u) or "state" (x). `directions` has a row for each bound and a column for each input
/// or state. A `soft` limit gives way first when not all can be kept.
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

/// The samples on which a limit holds.
fn samples_of(samples: &Bound<'_, PyAny>) -> PyResult<Vec<usize>> {
    wholes("samples", samples, 0..=MOST_SAMPLES)
}

/// A matrix of finite numbers.
fn finite(name: &str, value: &Bound<'_, PyAny>) -> PyResult<DMatrix<f64>> {
    let matrix = matrix(name, value)?;
    check_finite(name, matrix.as_slice())?;
    Ok(matrix)
}

#[pymethods]
impl Limit {
    #[new]
    #[pyo3(signature = (quantity, directions, samples, soft = false))]
    fn new(
        quantity: &str,
        directions: &Bound<'_, PyAny>,
        samples: &Bound<'_, PyAny>,
        soft: bool,
    ) -> PyResult<Self> {
        let (directions, samples) = (finite("directions", directions)?, samples_of(samples)?);
        Ok(Self(lmpc::Limit { quantity: quantity_of(quantity)?, directions, samples, soft }))
    }

    /// Upper and lower bounds of `count` inputs or states, 1 to 1000: `upper` is [largest…, −smallest…].
    #[staticmethod]
    #[pyo3(signature = (quantity, count, samples, soft = false))]
    fn range(
        quantity: &str,
        count: &Bound<'_, PyAny>,
        samples: &Bound<'_, PyAny>,
        soft: bool,
    ) -> PyResult<Self> {
        let (count, samples) = (whole("count", count, 1..=MOST)?, samples_of(samples)?);
        let limit = lmpc::Limit::range(quantity_of(quantity)?, count, samples);
        Ok(Self(lmpc::Limit { soft, ..limit }))
    }

    /// A joint bound of two inputs or states: a regular polygon of 3 to 1000 sides; `upper` = r cos(π/sides) lies inside the circle of radius r.
    #[staticmethod]
    #[pyo3(signature = (quantity, sides, samples, soft = false))]
    fn polygon(
        quantity: &str,
        sides: &Bound<'_, PyAny>,
        samples: &Bound<'_, PyAny>,
        soft: bool,
    ) -> PyResult<Self> {
        let (sides, samples) = (whole("sides", sides, 3..=MOST)?, samples_of(samples)?);
        let limit = lmpc::Limit::polygon(quantity_of(quantity)?, sides, samples);
        Ok(Self(lmpc::Limit { soft, ..limit }))
    }

    /// How many values of `upper` it takes.
    #[getter]
    fn bounds(&self) -> usize {
        self.0.directions.nrows()
    }
}

/// directions · (C x + D u) ≤ upper on some samples, of a signal with at most three components.
///
/// `relaxation` is by how much each bound gives way per unit of the slack that all limits share, in units of the signal.
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
        samples: &Bound<'_, PyAny>,
        relaxation: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let relaxation = positive("relaxation", relaxation)?;
        let (state, input, directions) =
            (finite("c", c)?, finite("d", d)?, finite("directions", directions)?);
        let components = state.nrows();
        if !(1..=MOST_COMPONENTS).contains(&components) {
            return Err(ArgumentError::new_err(format!(
                "c has {components} rows; allowed are 1 to {MOST_COMPONENTS}, one for each component of the signal"
            )));
        }
        for (name, found, what) in
            [("d", input.nrows(), "rows"), ("directions", directions.ncols(), "columns")]
        {
            if found != components {
                return Err(ArgumentError::new_err(format!(
                    "{name} has {found} {what}, expected {components}: one for each row of c"
                )));
            }
        }
        let samples = samples_of(samples)?;
        Ok(Self(lmpc::SignalLimit { state, input, directions, samples, relaxation }))
    }

    /// Upper and lower bounds of all inputs: `upper` is [largest…, −smallest…].
    #[staticmethod]
    fn input_range(
        states: &Bound<'_, PyAny>,
        inputs: &Bound<'_, PyAny>,
        samples: &Bound<'_, PyAny>,
        relaxation: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let (states, inputs) = (whole("states", states, 1..=MOST)?, whole("inputs", inputs, 1..=MOST)?);
        let directions = lmpc::SignalLimit::range(inputs);
        let limit = lmpc::SignalLimit::of_inputs(states, inputs, directions, samples_of(samples)?);
        Ok(Self(limit.giving_way_by(positive("relaxation", relaxation)?)))
    }

    /// Upper and lower bounds of the states with these indices: `upper` is [largest…, −smallest…].
    #[staticmethod]
    fn state_range(
        states: &Bound<'_, PyAny>,
        inputs: &Bound<'_, PyAny>,
        limited: &Bound<'_, PyAny>,
        samples: &Bound<'_, PyAny>,
        relaxation: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let (states, inputs) = (whole("states", states, 1..=MOST)?, whole("inputs", inputs, 1..=MOST)?);
        let limited = wholes("limited", limited, 0..=states - 1)?;
        let directions: DMatrix<f64> = lmpc::SignalLimit::range(limited.len());
        let limit = lmpc::SignalLimit::of_states(states, inputs, &limited, directions, samples_of(samples)?);
        Ok(Self(limit.giving_way_by(positive("relaxation", relaxation)?)))
    }

    /// How many values of `upper` it takes.
    #[getter]
    fn bounds(&self) -> usize {
        self.0.directions.nrows()
    }
}
