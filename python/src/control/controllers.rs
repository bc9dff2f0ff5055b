//! Control laws at run time, with the state that they keep from one sample to the next.

use lmpc::{DesignError as Refusal, LaguerreMpc, StabilizedMpc, StateFeedback, StateSpaceMpc};
use nalgebra::DMatrix;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use super::designs::{LmpcDesign, StabilizedDesign, StateSpaceMpcDesign};
use super::law::{self, Answer, Law, MOST_INPUTS, MOST_STATES, MOST_UNKNOWNS, Recipe, Told};
use super::limits::{Limit, SignalLimit};
use super::models::StateSpace;
use super::padding;
use crate::arguments::{objects_or_none, positive};
use crate::arrays::{array1, check_matrix, elements, finite_vector_of, matrix, vector, vector_of};
use crate::errors::{self, ArgumentError};

/// What a controller decided at a sample.
#[pyclass(frozen, module = "lmpc_quadrotor.control")]
pub struct Step(Answer);

#[pymethods]
impl Step {
    /// u(k), p: to be applied.
    #[getter]
    fn input<'py>(&self, python: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array1(python, &self.0.input)
    }

    /// Δu(k), p.
    #[getter]
    fn increment<'py>(&self, python: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array1(python, &self.0.increment)
    }

    /// The share of the integral action in Δu, p; zero under limits that are active.
    #[getter]
    fn integral<'py>(&self, python: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array1(python, &self.0.integral)
    }

    /// How the input was found: "relaxed" when not all limits can be kept, "held" when a number was not finite.
    #[getter]
    fn status(&self) -> &'static str {
        self.0.status
    }

    /// Of the solver; 0 when no limit was near.
    #[getter]
    fn iterations(&self) -> u32 {
        self.0.iterations
    }

    /// Limits that are active.
    #[getter]
    fn active(&self) -> usize {
        self.0.active
    }

    fn __repr__(&self) -> String {
        format!("Step(input={:?}, status={:?}, active={})", self.0.input, self.0.status, self.0.active)
    }
}

/// A control law with its state: the last measurement, the last input, and the limits that were active.
///
/// At most 16 states, 4 inputs, as many outputs as inputs, and 64 Laguerre terms or moves of all inputs together.
#[pyclass(module = "lmpc_quadrotor.control")]
pub struct Controller {
    law: Box<dyn Law>,
    states: usize,
    inputs: usize,
    outputs: usize,
    bounds: usize,
}

struct Feedback<'a> {
    plant: &'a lmpc::StateSpace,
    gain: &'a DMatrix<f64>,
}

impl Recipe for Feedback<'_> {
    fn make<const N: usize, const P: usize, const Q: usize, const E: usize>(
        &self,
    ) -> Result<Box<dyn Law>, Refusal> {
        let gain = padding::columns(self.gain, self.plant.states(), N);
        Ok(law::at_rest::<N, P, Q, 0>(StateFeedback::<N, P, Q>::new(&gain)?, self.plant.c()))
    }
}

struct Laguerre<'a> {
    design: &'a LmpcDesign,
    limits: Vec<lmpc::Limit>,
    model_increment: bool,
}

impl Recipe for Laguerre<'_> {
    fn make<const N: usize, const P: usize, const Q: usize, const E: usize>(
        &self,
    ) -> Result<Box<dyn Law>, Refusal> {
        let LmpcDesign { problem, horizon, weighting, .. } = self.design;
        let mut padded = problem.clone();
        padded.plant = padding::plant(&problem.plant, N)?;
        padded.q = padding::weight(&problem.q, problem.plant.states(), N);
        let design = LmpcDesign::of(&padded, *horizon, *weighting)?;
        let limits = padding::limits(&self.limits, N);
        let law = if self.model_increment {
            LaguerreMpc::<N, P, Q, E>::with_model_increment(&design, &limits)?
        } else {
            LaguerreMpc::<N, P, Q, E>::new(&design, &limits)?
        };
        Ok(law::at_rest::<N, P, Q, E>(law, problem.plant.c()))
    }
}

struct Stabilized<'a> {
    design: &'a StabilizedDesign,
    limits: Vec<lmpc::SignalLimit>,
    slack_cost: f64,
}

impl Recipe for Stabilized<'_> {
    fn make<const N: usize, const P: usize, const Q: usize, const E: usize>(
        &self,
    ) -> Result<Box<dyn Law>, Refusal> {
        let StabilizedDesign { problem, stabilizing_gain, degree, .. } = self.design;
        let states = problem.plant.states();
        let mut padded = problem.clone();
        padded.plant = padding::plant(&problem.plant, N)?;
        padded.q = padding::weight(&problem.q, states, N);
        let gain = padding::columns(stabilizing_gain, states, N);
        let design = StabilizedDesign::of(&padded, &gain, *degree)?;
        let limits = padding::signal_limits(&self.limits, N);
        let law = StabilizedMpc::<N, P, Q, E>::new(&design, &limits, self.slack_cost)?;
        Ok(law::at_rest::<N, P, Q, E>(law, problem.plant.c()))
    }
}

struct Moves<'a> {
    design: &'a StateSpaceMpcDesign,
    limits: Vec<lmpc::Limit>,
}

impl Recipe for Moves<'_> {
    fn make<const N: usize, const P: usize, const Q: usize, const E: usize>(
        &self,
    ) -> Result<Box<dyn Law>, Refusal> {
        let StateSpaceMpcDesign { plant, weights, horizon, moves, .. } = self.design;
        let (padded, weights) = (padding::plant(plant, N)?, padding::weights(weights, N));
        let design = lmpc::StateSpaceMpcDesign::with_weights(&padded, &weights, *horizon, *moves)?;
        let limits = padding::limits(&self.limits, N);
        Ok(law::at_rest::<N, P, Q, E>(StateSpaceMpc::<N, P, Q, E>::new(&design, &limits)?, plant.c()))
    }
}

impl Controller {
    fn of(
        python: Python<'_>,
        recipe: &(impl Recipe + Sync),
        plant: &lmpc::StateSpace,
        terms: usize,
        bounds: usize,
    ) -> PyResult<Self> {
        let (states, inputs, outputs) = (plant.states(), plant.inputs(), plant.outputs());
        let made = python.detach(|| law::make(recipe, states, (inputs, outputs), terms + 1));
        let law = made.ok_or_else(|| {
            ArgumentError::new_err(format!(
                "no controller has this size: {states} states, {inputs} inputs, {outputs} outputs and {terms} Laguerre terms or \
                 moves; allowed are at most {MOST_STATES} states, {MOST_INPUTS} inputs, as many outputs as inputs, and {} \
                 terms or moves of all inputs together",
                MOST_UNKNOWNS - 1
            ))
        })?;
        Ok(Self { law: law.map_err(|refusal| errors::design(&refusal))?, states, inputs, outputs, bounds })
    }
}

/// Limits from a list of them.
fn limits_of(limits: Option<&Bound<'_, PyAny>>) -> PyResult<Vec<lmpc::Limit>> {
    let limits: Vec<PyRef<'_, Limit>> = objects_or_none("limits", limits, "Limit")?;
    Ok(limits.iter().map(|limit| limit.0.clone()).collect())
}

/// Refuses limits whose directions do not fit the plant, before zeros make them fit.
fn check_limits(limits: &[lmpc::Limit], plant: &lmpc::StateSpace) -> PyResult<()> {
    for limit in limits {
        let columns = match limit.quantity {
            lmpc::Quantity::State => plant.states(),
            lmpc::Quantity::Increment | lmpc::Quantity::Input => plant.inputs(),
        };
        if limit.directions.ncols() != columns {
            return Err(ArgumentError::new_err(format!(
                "limits: directions of a limit have {} columns, expected {columns}",
                limit.directions.ncols()
            )));
        }
    }
    Ok(())
}

#[pymethods]
impl Controller {
    /// Δu = −K [Δx; y − r] with K p×(n+q): a regulator, or Laguerre MPC without limits.
    #[staticmethod]
    fn state_feedback(python: Python<'_>, plant: &StateSpace, gain: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (plant, gain) = (&plant.0, matrix("gain", gain)?);
        let expected = (plant.inputs(), plant.states() + plant.outputs());
        if gain.shape() != expected {
            let refusal = Refusal::Dimension { name: "gain", expected, actual: gain.shape() };
            return Err(errors::design(&refusal));
        }
        check_matrix("gain", &gain)?;
        Self::of(python, &Feedback { plant, gain: &gain }, plant, 0, 0)
    }

    /// Laguerre MPC under limits. With `model_increment` the increment follows from the model: for actuators that lag.
    #[staticmethod]
    #[pyo3(
        signature = (design, limits = None, model_increment = false),
        text_signature = "(design, limits=..., model_increment=False)"
    )]
    fn laguerre_mpc(
        python: Python<'_>,
        design: &LmpcDesign,
        limits: Option<&Bound<'_, PyAny>>,
        model_increment: bool,
    ) -> PyResult<Self> {
        let limits = limits_of(limits)?;
        let plant = &design.problem.plant;
        check_limits(&limits, plant)?;
        let terms = design.problem.bases.iter().map(lmpc::LaguerreBasis::terms).sum();
        let bounds = limits.iter().map(|limit| limit.directions.nrows()).sum();
        let recipe = Laguerre { design, limits, model_increment };
        Self::of(python, &recipe, plant, terms, bounds)
    }

    /// Laguerre MPC about a stabilizing feedback, under limits whose common slack of 1 costs `slack_cost`.
    #[staticmethod]
    #[pyo3(
        signature = (design, limits = None, slack_cost = None),
        text_signature = "(design, limits=..., slack_cost=10000.0)"
    )]
    fn stabilized_mpc(
        python: Python<'_>,
        design: &StabilizedDesign,
        limits: Option<&Bound<'_, PyAny>>,
        slack_cost: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let limits: Vec<PyRef<'_, SignalLimit>> = objects_or_none("limits", limits, "SignalLimit")?;
        let limits: Vec<_> = limits.iter().map(|limit| limit.0.clone()).collect();
        let plant = &design.problem.plant;
        for limit in &limits {
            for (name, found, expected) in
                [("c", limit.state.ncols(), plant.states()), ("d", limit.input.ncols(), plant.inputs())]
            {
                if found != expected {
                    return Err(ArgumentError::new_err(format!(
                        "limits: {name} of a limit has {found} columns, expected {expected}"
                    )));
                }
            }
        }
        let slack_cost = slack_cost.map_or(Ok(1e4), |cost| positive("slack_cost", cost))?;
        let terms = design.problem.bases.iter().map(lmpc::LaguerreBasis::terms).sum();
        let bounds = limits.iter().map(|limit| limit.directions.nrows()).sum();
        Self::of(python, &Stabilized { design, limits, slack_cost }, plant, terms, bounds)
    }

    /// State-space MPC under limits; those of states bound the deviation from the reference.
    #[staticmethod]
    #[pyo3(signature = (design, limits = None), text_signature = "(design, limits=...)")]
    fn state_space_mpc(
        python: Python<'_>,
        design: &StateSpaceMpcDesign,
        limits: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let limits = limits_of(limits)?;
        check_limits(&limits, &design.plant)?;
        let bounds = limits.iter().map(|limit| limit.directions.nrows()).sum();
        let terms = design.moves * design.plant.inputs();
        Self::of(python, &Moves { design, limits }, &design.plant, terms, bounds)
    }

    /// One sample: from the state `measured`, n, to the input, which is taken as applied: see `apply`.
    ///
    /// `reference` is the state to be in, n; `reference_increment` what a plant on a moving reference moves by, n;
    /// `input_reference` the input that keeps it there, p; `disturbance` an estimate that acts as an input, p; `upper` the
    /// values of all bounds, one limit after the other, none if left out; `preview` r(k), r(k+1), … as deviations from the
    /// reference, a row of q numbers each, for `state_space_mpc`. What is left out is zero.
    #[pyo3(signature = (measured, reference = None, *, reference_increment = None, input_reference = None,
                        disturbance = None, upper = None, preview = None))]
    #[allow(clippy::too_many_arguments, reason = "keywords in Python")]
    fn step(
        &mut self,
        measured: &Bound<'_, PyAny>,
        reference: Option<&Bound<'_, PyAny>>,
        reference_increment: Option<&Bound<'_, PyAny>>,
        input_reference: Option<&Bound<'_, PyAny>>,
        disturbance: Option<&Bound<'_, PyAny>>,
        upper: Option<&Bound<'_, PyAny>>,
        preview: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Step> {
        let upper = match upper {
            Some(upper) => vector("upper", upper)?.as_slice().to_vec(),
            None => Vec::new(),
        };
        if !upper.is_empty() && upper.len() != self.bounds {
            return Err(ArgumentError::new_err(format!(
                "upper has {}, expected {}: one for each direction of each limit",
                elements(upper.len()),
                self.bounds
            )));
        }
        let preview = match preview {
            Some(preview) => {
                let rows = matrix("preview", preview)?;
                if rows.ncols() != self.outputs {
                    return Err(ArgumentError::new_err(format!(
                        "preview has {} columns, expected {}",
                        rows.ncols(),
                        self.outputs
                    )));
                }
                rows.row_iter().map(|row| row.transpose()).collect()
            }
            None => Vec::new(),
        };
        let told = Told {
            measured: vector_of("measured", Some(measured), self.states)?,
            reference: vector_of("reference", reference, self.states)?,
            reference_increment: vector_of("reference_increment", reference_increment, self.states)?,
            input_reference: vector_of("input_reference", input_reference, self.inputs)?,
            disturbance: vector_of("disturbance", disturbance, self.inputs)?,
            upper,
            preview,
        };
        Ok(Step(self.law.step(&told)))
    }

    /// Begins anew with a plant whose last state and input these were, n and p, p of it feed-forward; zero if left out.
    #[pyo3(signature = (measured = None, applied = None, input_reference = None))]
    fn take_over(
        &mut self,
        measured: Option<&Bound<'_, PyAny>>,
        applied: Option<&Bound<'_, PyAny>>,
        input_reference: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        self.law.take_over(
            &finite_vector_of("measured", measured, self.states)?,
            &finite_vector_of("applied", applied, self.inputs)?,
            &finite_vector_of("input_reference", input_reference, self.inputs)?,
        );
        Ok(())
    }

    /// Reports the input that was applied in truth, p, so that saturation does not wind up the integral action.
    ///
    /// What is not finite is ignored.
    fn apply(&mut self, applied: &Bound<'_, PyAny>) -> PyResult<()> {
        self.law.apply(&vector_of("applied", Some(applied), self.inputs)?);
        Ok(())
    }

    /// The state, to go on from with `restore`.
    fn save<'py>(&self, python: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let saved =
            self.law.save().map_err(|error| ArgumentError::new_err(format!("cannot save: {error}")))?;
        Ok(PyBytes::new(python, &saved))
    }

    /// Goes on from a saved state of a controller of the same sizes.
    fn restore(&mut self, saved: &[u8]) -> PyResult<()> {
        self.law
            .restore(saved)
            .map_err(|error| ArgumentError::new_err(format!("saved is no state of this controller: {error}")))
    }

    /// How many values of `upper` a step takes.
    #[getter]
    fn bounds(&self) -> usize {
        self.bounds
    }
}
