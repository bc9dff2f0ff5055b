//! Designs: gains that are computed before a flight.

use lmpc::{Augmented, DesignError as Refusal, StateSpaceMpcWeights, Weighting, Weights};
use nalgebra::DMatrix;
use numpy::{Complex64, PyArray1, PyArray2};
use pyo3::prelude::*;

use super::bases::LaguerreBasis;
use super::models::StateSpace;
use crate::arrays::{array2, complex, matrix};
use crate::errors::{self, ArgumentError};
use crate::whole::Whole;

type Matrix<'py> = Bound<'py, PyArray2<f64>>;

/// The infinite-horizon linear quadratic regulator Δu = −K x.
#[pyclass(frozen, module = "lmpc_quadrotor.control")]
pub struct Dlqr(lmpc::Dlqr);

#[pymethods]
impl Dlqr {
    #[new]
    #[pyo3(signature = (a, b, q, r, degree = 1.0))]
    fn new(
        python: Python<'_>,
        a: &Bound<'_, PyAny>,
        b: &Bound<'_, PyAny>,
        q: &Bound<'_, PyAny>,
        r: &Bound<'_, PyAny>,
        degree: f64,
    ) -> PyResult<Self> {
        let (a, b, q, r) = (matrix("a", a)?, matrix("b", b)?, matrix("q", q)?, matrix("r", r)?);
        let design = python.detach(|| lmpc::Dlqr::new(&a, &b, &q, &r, degree));
        design.map(Self).map_err(|refusal| errors::design(&refusal))
    }

    #[staticmethod]
    fn exponentially_weighted(
        a: &Bound<'_, PyAny>,
        b: &Bound<'_, PyAny>,
        q: &Bound<'_, PyAny>,
        r: &Bound<'_, PyAny>,
        alpha: f64,
    ) -> PyResult<Self> {
        let (a, b, q, r) = (matrix("a", a)?, matrix("b", b)?, matrix("q", q)?, matrix("r", r)?);
        let design = lmpc::Dlqr::exponentially_weighted(&a, &b, &q, &r, alpha);
        design.map(Self).map_err(|refusal| errors::design(&refusal))
    }

    #[getter]
    fn gain<'py>(&self, python: Python<'py>) -> PyResult<Matrix<'py>> {
        array2(python, self.0.gain())
    }

    #[getter]
    fn cost<'py>(&self, python: Python<'py>) -> PyResult<Matrix<'py>> {
        array2(python, self.0.cost())
    }

    #[getter]
    fn radius(&self) -> f64 {
        self.0.radius()
    }
}

/// What an incremental design is made of, kept so that it can be made again for a plant with more states.
#[derive(Clone)]
pub struct Problem {
    pub plant: lmpc::StateSpace,
    pub q: DMatrix<f64>,
    pub r: DMatrix<f64>,
    pub bases: Vec<lmpc::LaguerreBasis>,
}

impl Problem {
    fn new(
        plant: &StateSpace,
        q: &Bound<'_, PyAny>,
        r: &Bound<'_, PyAny>,
        bases: Vec<PyRef<'_, LaguerreBasis>>,
    ) -> PyResult<Self> {
        let bases = bases.iter().map(|basis| basis.0.clone()).collect();
        Ok(Self { plant: plant.0.clone(), q: matrix("q", q)?, r: matrix("r", r)?, bases })
    }

    /// The incremental model and its weights.
    pub fn weighted(&self) -> Result<(Augmented, Weights), Refusal> {
        let model = Augmented::new(&self.plant);
        let weights = Weights::new(&model, self.q.clone(), self.r.clone())?;
        Ok((model, weights))
    }
}

/// Laguerre MPC over a finite horizon.
#[pyclass(frozen, module = "lmpc_quadrotor.control")]
pub struct LmpcDesign {
    pub problem: Problem,
    pub horizon: usize,
    pub weighting: Weighting,
    pub design: lmpc::LmpcDesign,
}

impl LmpcDesign {
    /// The design of a problem.
    pub fn of(problem: &Problem, horizon: usize, weighting: Weighting) -> Result<lmpc::LmpcDesign, Refusal> {
        let (model, weights) = problem.weighted()?;
        lmpc::LmpcDesign::new(&model, &weights, &problem.bases, horizon, weighting)
    }
}

#[pymethods]
impl LmpcDesign {
    #[new]
    #[pyo3(signature = (plant, q, r, bases, horizon, weighting = "terminal", alpha = 1.0, degree = 1.0))]
    #[allow(clippy::too_many_arguments, reason = "keywords in Python")]
    fn new(
        python: Python<'_>,
        plant: &StateSpace,
        q: &Bound<'_, PyAny>,
        r: &Bound<'_, PyAny>,
        bases: Vec<PyRef<'_, LaguerreBasis>>,
        horizon: Whole,
        weighting: &str,
        alpha: f64,
        degree: f64,
    ) -> PyResult<Self> {
        let Whole(horizon) = horizon;
        let weighting = match weighting {
            "terminal" => Weighting::Terminal { lambda: degree },
            "exponential" => Weighting::exponential(alpha, degree),
            "literal" => Weighting::Literal { alpha },
            other => {
                return Err(ArgumentError::new_err(format!(
                    "weighting = {other:?}; allowed are 'terminal', 'exponential' and 'literal'"
                )));
            }
        };
        let problem = Problem::new(plant, q, r, bases)?;
        let design = python.detach(|| Self::of(&problem, horizon, weighting));
        let design = design.map_err(|refusal| errors::design(&refusal))?;
        Ok(Self { problem, horizon, weighting, design })
    }

    #[getter]
    fn gain<'py>(&self, python: Python<'py>) -> PyResult<Matrix<'py>> {
        array2(python, self.design.gain())
    }

    #[getter]
    fn dlqr_gain<'py>(&self, python: Python<'py>) -> PyResult<Matrix<'py>> {
        array2(python, self.design.dlqr().gain())
    }

    #[getter]
    fn omega<'py>(&self, python: Python<'py>) -> PyResult<Matrix<'py>> {
        array2(python, self.design.prediction().omega())
    }

    #[getter]
    fn psi<'py>(&self, python: Python<'py>) -> PyResult<Matrix<'py>> {
        array2(python, self.design.prediction().psi())
    }

    #[getter]
    fn closed_loop_eigenvalues<'py>(&self, python: Python<'py>) -> PyResult<Bound<'py, PyArray1<Complex64>>> {
        let found = self.design.closed_loop_eigenvalues().map_err(|refusal| errors::design(&refusal))?;
        Ok(complex(python, &found))
    }

    #[getter]
    fn spectral_radius(&self) -> f64 {
        self.design.spectral_radius()
    }

    #[getter]
    fn condition_number(&self) -> f64 {
        self.design.condition_number()
    }

    #[getter]
    fn gain_error(&self) -> f64 {
        self.design.gain_error()
    }
}

/// Laguerre MPC about a stabilizing feedback, over the infinite horizon.
#[pyclass(frozen, module = "lmpc_quadrotor.control")]
pub struct StabilizedDesign {
    pub problem: Problem,
    pub stabilizing_gain: DMatrix<f64>,
    pub degree: f64,
    pub design: lmpc::StabilizedDesign,
}

impl StabilizedDesign {
    /// The design of a problem.
    pub fn of(
        problem: &Problem,
        stabilizing_gain: &DMatrix<f64>,
        degree: f64,
    ) -> Result<lmpc::StabilizedDesign, Refusal> {
        let (model, weights) = problem.weighted()?;
        lmpc::StabilizedDesign::new(&model, &weights, stabilizing_gain, &problem.bases, degree)
    }
}

#[pymethods]
impl StabilizedDesign {
    #[new]
    #[pyo3(signature = (plant, q, r, stabilizing_gain, bases, degree = 1.0))]
    fn new(
        python: Python<'_>,
        plant: &StateSpace,
        q: &Bound<'_, PyAny>,
        r: &Bound<'_, PyAny>,
        stabilizing_gain: &Bound<'_, PyAny>,
        bases: Vec<PyRef<'_, LaguerreBasis>>,
        degree: f64,
    ) -> PyResult<Self> {
        let problem = Problem::new(plant, q, r, bases)?;
        let stabilizing_gain = matrix("stabilizing_gain", stabilizing_gain)?;
        let design = python.detach(|| Self::of(&problem, &stabilizing_gain, degree));
        let design = design.map_err(|refusal| errors::design(&refusal))?;
        Ok(Self { problem, stabilizing_gain, degree, design })
    }

    #[getter]
    fn gain<'py>(&self, python: Python<'py>) -> PyResult<Matrix<'py>> {
        array2(python, self.design.gain())
    }

    #[getter]
    fn stabilizing_gain<'py>(&self, python: Python<'py>) -> PyResult<Matrix<'py>> {
        array2(python, self.design.stabilizing_gain())
    }

    #[getter]
    fn cost<'py>(&self, python: Python<'py>) -> PyResult<Matrix<'py>> {
        array2(python, self.design.cost())
    }

    #[getter]
    fn dlqr_gain<'py>(&self, python: Python<'py>) -> PyResult<Matrix<'py>> {
        array2(python, self.design.dlqr().gain())
    }

    #[getter]
    fn spectral_radius(&self) -> f64 {
        self.design.spectral_radius()
    }

    #[getter]
    fn condition_number(&self) -> f64 {
        self.design.condition_number()
    }
}

/// State-space MPC: one unknown per move.
#[pyclass(frozen, module = "lmpc_quadrotor.control")]
pub struct StateSpaceMpcDesign {
    pub plant: lmpc::StateSpace,
    pub weights: StateSpaceMpcWeights,
    pub horizon: usize,
    pub moves: usize,
    pub design: lmpc::StateSpaceMpcDesign,
}

#[pymethods]
impl StateSpaceMpcDesign {
    #[new]
    #[pyo3(signature = (plant, output_weight, move_weight, horizon, moves, increment_weight = None, terminal = None))]
    #[allow(clippy::too_many_arguments, reason = "keywords in Python")]
    fn new(
        python: Python<'_>,
        plant: &StateSpace,
        output_weight: &Bound<'_, PyAny>,
        move_weight: &Bound<'_, PyAny>,
        horizon: Whole,
        moves: Whole,
        increment_weight: Option<&Bound<'_, PyAny>>,
        terminal: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let (Whole(horizon), Whole(moves)) = (horizon, moves);
        let plant = plant.0.clone();
        let weights = StateSpaceMpcWeights {
            output: matrix("output_weight", output_weight)?,
            moves: matrix("move_weight", move_weight)?,
            increment: match increment_weight {
                Some(weight) => matrix("increment_weight", weight)?,
                None => DMatrix::zeros(plant.states(), plant.states()),
            },
            terminal: terminal.map(|weight| matrix("terminal", weight)).transpose()?,
        };
        let design =
            python.detach(|| lmpc::StateSpaceMpcDesign::with_weights(&plant, &weights, horizon, moves));
        let design = design.map_err(|refusal| errors::design(&refusal))?;
        Ok(Self { plant, weights, horizon, moves, design })
    }

    /// K_x and K_u of the law without limits: Δu = −K_x (x − x_r) − K_u v.
    #[getter]
    fn gains<'py>(&self, python: Python<'py>) -> PyResult<(Matrix<'py>, Matrix<'py>)> {
        let (state, input) = self.design.gains().map_err(|refusal| errors::design(&refusal))?;
        Ok((array2(python, &state)?, array2(python, &input)?))
    }

    #[getter]
    fn hessian<'py>(&self, python: Python<'py>) -> PyResult<Matrix<'py>> {
        array2(python, self.design.hessian())
    }

    #[getter]
    fn spectral_radius(&self) -> f64 {
        self.design.spectral_radius()
    }
}
