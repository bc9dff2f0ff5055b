//! Designs: gains that are computed before a flight.

use lmpc::{Augmented, DesignError as Refusal, StateSpaceMpcWeights, Weighting, Weights};
use nalgebra::DMatrix;
use numpy::{Complex64, PyArray1, PyArray2};
use pyo3::prelude::*;

use super::bases::LaguerreBasis;
use super::models::StateSpace;
use crate::arguments::{MOST, MOST_SAMPLES, number, number_or, objects, whole};
use crate::arrays::{array2, complex, matrix};
use crate::errors::{self, ArgumentError};

type Matrix<'py> = Bound<'py, PyArray2<f64>>;

/// The infinite-horizon regulator Δu = −K x of x(k+1) = A x + B Δu.
///
/// It minimizes Σ λ^(−2j) (xᵀQx + ΔuᵀRΔu), so that all eigenvalues of the closed loop are smaller than λ = `degree`, 0 < λ ≤ 1.
/// Q must be symmetric and positive semidefinite, R symmetric and positive definite.
#[pyclass(frozen, module = "lmpc_quadrotor.control")]
pub struct Dlqr(lmpc::Dlqr);

#[pymethods]
impl Dlqr {
    #[new]
    #[pyo3(signature = (a, b, q, r, degree = None), text_signature = "(a, b, q, r, degree=1.0)")]
    fn new(
        python: Python<'_>,
        a: &Bound<'_, PyAny>,
        b: &Bound<'_, PyAny>,
        q: &Bound<'_, PyAny>,
        r: &Bound<'_, PyAny>,
        degree: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let degree = number_or("degree", degree, 1.0)?;
        let (a, b, q, r) = (matrix("a", a)?, matrix("b", b)?, matrix("q", q)?, matrix("r", r)?);
        let design = python.detach(|| lmpc::Dlqr::new(&a, &b, &q, &r, degree));
        design.map(Self).map_err(|refusal| errors::design(&refusal))
    }

    /// The regulator of Σ α^(−2j) (xᵀQx + ΔuᵀRΔu), α ≥ 1: all eigenvalues are smaller than α, so it need not be stable.
    #[staticmethod]
    fn exponentially_weighted(
        a: &Bound<'_, PyAny>,
        b: &Bound<'_, PyAny>,
        q: &Bound<'_, PyAny>,
        r: &Bound<'_, PyAny>,
        alpha: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let alpha = number("alpha", alpha)?;
        let (a, b, q, r) = (matrix("a", a)?, matrix("b", b)?, matrix("q", q)?, matrix("r", r)?);
        let design = lmpc::Dlqr::exponentially_weighted(&a, &b, &q, &r, alpha);
        design.map(Self).map_err(|refusal| errors::design(&refusal))
    }

    /// K, p×n.
    #[getter]
    fn gain<'py>(&self, python: Python<'py>) -> PyResult<Matrix<'py>> {
        array2(python, self.0.gain())
    }

    /// P, n×n: from the state x on it costs xᵀPx.
    #[getter]
    fn cost<'py>(&self, python: Python<'py>) -> PyResult<Matrix<'py>> {
        array2(python, self.0.cost())
    }

    /// What every eigenvalue of the closed loop is smaller than.
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
        bases: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let bases: Vec<PyRef<'_, LaguerreBasis>> = objects("bases", bases, "LaguerreBasis")?;
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

/// Laguerre MPC on the incremental model of a plant over N_p = `horizon` samples, 1 to 10 000, with a basis for each input.
///
/// Q is (n+q)×(n+q), R p×p. `weighting` says how the cost depends on the sample:
///
/// * "terminal": the regulator's cost stands at the end of the horizon; the better choice under limits;
/// * "exponential": Wang's, with `alpha` ≥ 1; well conditioned for any horizon;
/// * "literal": the paper's, which need not give a stable loop, and is refused then.
///
/// `degree` λ, 0 < λ ≤ 1: all eigenvalues of the closed loop are asked to be smaller. "terminal" takes no `alpha`, "literal" no
/// `degree`.
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
    #[pyo3(
        signature = (plant, q, r, bases, horizon, weighting = "terminal", alpha = None, degree = None),
        text_signature = "(plant, q, r, bases, horizon, weighting='terminal', alpha=1.0, degree=1.0)"
    )]
    #[allow(clippy::too_many_arguments, reason = "keywords in Python")]
    fn new(
        python: Python<'_>,
        plant: &StateSpace,
        q: &Bound<'_, PyAny>,
        r: &Bound<'_, PyAny>,
        bases: &Bound<'_, PyAny>,
        horizon: &Bound<'_, PyAny>,
        weighting: &str,
        alpha: Option<&Bound<'_, PyAny>>,
        degree: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let horizon = whole("horizon", horizon, 1..=MOST_SAMPLES)?;
        let (alpha, degree) = (number_or("alpha", alpha, 1.0)?, number_or("degree", degree, 1.0)?);
        let weighting = match weighting {
            "terminal" if alpha != 1.0 => {
                return Err(ArgumentError::new_err(format!(
                    "alpha = {alpha} has no effect with weighting = 'terminal'; choose 'exponential' or 'literal', or leave it out"
                )));
            }
            "terminal" => Weighting::Terminal { lambda: degree },
            "exponential" => Weighting::exponential(alpha, degree),
            "literal" if degree != 1.0 => {
                return Err(ArgumentError::new_err(format!(
                    "degree = {degree} has no effect with weighting = 'literal'; choose 'terminal' or 'exponential', or leave it out"
                )));
            }
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

    /// K, p×(n+q): without limits Δu = −K [Δx; y − r].
    #[getter]
    fn gain<'py>(&self, python: Python<'py>) -> PyResult<Matrix<'py>> {
        array2(python, self.design.gain())
    }

    /// The gain of the infinite-horizon regulator of the same weights, p×(n+q).
    #[getter]
    fn dlqr_gain<'py>(&self, python: Python<'py>) -> PyResult<Matrix<'py>> {
        array2(python, self.design.dlqr().gain())
    }

    /// Ω of the cost ηᵀΩη + 2ηᵀΨx, ΣN×ΣN.
    #[getter]
    fn omega<'py>(&self, python: Python<'py>) -> PyResult<Matrix<'py>> {
        array2(python, self.design.prediction().omega())
    }

    /// Ψ, ΣN×(n+q).
    #[getter]
    fn psi<'py>(&self, python: Python<'py>) -> PyResult<Matrix<'py>> {
        array2(python, self.design.prediction().psi())
    }

    /// Eigenvalues of A − BK, n+q.
    #[getter]
    fn closed_loop_eigenvalues<'py>(&self, python: Python<'py>) -> PyResult<Bound<'py, PyArray1<Complex64>>> {
        let found = self.design.closed_loop_eigenvalues().map_err(|refusal| errors::design(&refusal))?;
        Ok(complex(python, &found))
    }

    /// Their largest magnitude, below 1.
    #[getter]
    fn spectral_radius(&self) -> f64 {
        self.design.spectral_radius()
    }

    /// Of Ω.
    #[getter]
    fn condition_number(&self) -> f64 {
        self.design.condition_number()
    }

    /// Share of the gain that rounding may have changed, at most.
    #[getter]
    fn gain_error(&self) -> f64 {
        self.design.gain_error()
    }
}

/// Laguerre MPC whose plan is about a slow, stabilizing feedback K_s, p×(n+q), over the infinite horizon.
///
/// Scaling factors of the bases must be below `degree`.
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
    #[pyo3(
        signature = (plant, q, r, stabilizing_gain, bases, degree = None),
        text_signature = "(plant, q, r, stabilizing_gain, bases, degree=1.0)"
    )]
    fn new(
        python: Python<'_>,
        plant: &StateSpace,
        q: &Bound<'_, PyAny>,
        r: &Bound<'_, PyAny>,
        stabilizing_gain: &Bound<'_, PyAny>,
        bases: &Bound<'_, PyAny>,
        degree: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let degree = number_or("degree", degree, 1.0)?;
        let problem = Problem::new(plant, q, r, bases)?;
        let stabilizing_gain = matrix("stabilizing_gain", stabilizing_gain)?;
        let design = python.detach(|| Self::of(&problem, &stabilizing_gain, degree));
        let design = design.map_err(|refusal| errors::design_of(&refusal, &[("K_s", "stabilizing_gain")]))?;
        Ok(Self { problem, stabilizing_gain, degree, design })
    }

    /// K, p×(n+q): without limits Δu = −K [Δx; y − r].
    #[getter]
    fn gain<'py>(&self, python: Python<'py>) -> PyResult<Matrix<'py>> {
        array2(python, self.design.gain())
    }

    /// K_s, p×(n+q).
    #[getter]
    fn stabilizing_gain<'py>(&self, python: Python<'py>) -> PyResult<Matrix<'py>> {
        array2(python, self.design.stabilizing_gain())
    }

    /// S, (n+q+ΣN)²: a plan costs [x; η]ᵀ S [x; η].
    #[getter]
    fn cost<'py>(&self, python: Python<'py>) -> PyResult<Matrix<'py>> {
        array2(python, self.design.cost())
    }

    /// The gain of the infinite-horizon regulator of the same weights, p×(n+q).
    #[getter]
    fn dlqr_gain<'py>(&self, python: Python<'py>) -> PyResult<Matrix<'py>> {
        array2(python, self.design.dlqr().gain())
    }

    /// Largest magnitude of the eigenvalues of the closed loop, below 1.
    #[getter]
    fn spectral_radius(&self) -> f64 {
        self.design.spectral_radius()
    }

    /// Of the part of S that belongs to η.
    #[getter]
    fn condition_number(&self) -> f64 {
        self.design.condition_number()
    }
}

/// The weights of a state-space MPC as the formulas call them, and as Python does.
const NAMES: [(&str, &str); 4] =
    [("Q", "output_weight"), ("S", "move_weight"), ("W", "increment_weight"), ("P", "terminal")];

/// State-space MPC: `moves` unknowns for each input, 1 to 1000, within `horizon` samples, 2 to 10 000.
///
/// `output_weight` is q×q, on y − r; `move_weight` p×p, on Δu; `increment_weight` n×n, on Δx; `terminal` (n+q)×(n+q), on
/// [Δx; y − r] at the end of the horizon, for instance the cost of a `Dlqr`.
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
        horizon: &Bound<'_, PyAny>,
        moves: &Bound<'_, PyAny>,
        increment_weight: Option<&Bound<'_, PyAny>>,
        terminal: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let (horizon, moves) =
            (whole("horizon", horizon, 2..=MOST_SAMPLES)?, whole("moves", moves, 1..=MOST)?);
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
        let design = design.map_err(|refusal| errors::design_of(&refusal, &NAMES))?;
        Ok(Self { plant, weights, horizon, moves, design })
    }

    /// K_x, p×n, and K_u, p×p: without limits Δu = −K_x (x − x_r) − K_u u(k−1), relative to the reference.
    #[getter]
    fn gains<'py>(&self, python: Python<'py>) -> PyResult<(Matrix<'py>, Matrix<'py>)> {
        let (state, input) = self.design.gains().map_err(|refusal| errors::design(&refusal))?;
        Ok((array2(python, &state)?, array2(python, &input)?))
    }

    /// H of the quadratic program, p·moves squared.
    #[getter]
    fn hessian<'py>(&self, python: Python<'py>) -> PyResult<Matrix<'py>> {
        array2(python, self.design.hessian())
    }

    /// Largest magnitude of the eigenvalues of the closed loop without limits, below 1.
    #[getter]
    fn spectral_radius(&self) -> f64 {
        self.design.spectral_radius()
    }
}
