//! Weights of the cost, and how they vary over the prediction horizon.

use nalgebra::DMatrix;

use crate::{Augmented, DesignError, Dlqr, validate};

/// Q on the augmented state x = \[Δx_m; y − r\], (n+q)×(n+q), and R on the increments Δu, p×p.
#[derive(Clone, Debug, PartialEq)]
pub struct Weights {
    q: DMatrix<f64>,
    r: DMatrix<f64>,
}

impl Weights {
    /// From full matrices.
    ///
    /// # Errors
    /// [`DesignError::Dimension`], [`DesignError::ElementNotFinite`], [`DesignError::NotSymmetric`],
    /// [`DesignError::NotPositiveSemidefinite`] (Q), [`DesignError::NotPositiveDefinite`] (R).
    pub fn new(model: &Augmented, q: DMatrix<f64>, r: DMatrix<f64>) -> Result<Self, DesignError> {
        validate::shape("Q", &q, (model.states(), model.states()))?;
        validate::shape("R", &r, (model.inputs(), model.inputs()))?;
        validate::positive_semidefinite("Q", &q)?;
        validate::positive_definite("R", &r)?;
        Ok(Self { q, r })
    }

    /// The paper's choice: Q = `output` · CᵀC, R = `increment` · I.
    ///
    /// # Errors
    /// As [`Weights::new`].
    pub fn output(model: &Augmented, output: f64, increment: f64) -> Result<Self, DesignError> {
        let q = model.c().transpose() * model.c() * output;
        let r = DMatrix::identity(model.inputs(), model.inputs()) * increment;
        Self::new(model, q, r)
    }

    /// Q.
    pub fn q(&self) -> &DMatrix<f64> {
        &self.q
    }

    /// R.
    pub fn r(&self) -> &DMatrix<f64> {
        &self.r
    }
}

/// How the weights of sample m depend on m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Weighting {
    /// The recipe as (51)–(55) print it: prediction with A/α and B/α, Q and R unchanged.
    ///
    /// It promises only |eigenvalue| < α (57), and for many sample times and weights the closed loop is
    /// indeed unstable; such designs are refused. α = 1 is the plain finite-horizon cost (48).
    Literal {
        /// α ≥ 1.
        alpha: f64,
    },
    /// Exponential weighting whose optimum is the regulator of degree λ (Wang 2009, chapter 4): with
    /// γ = λ/α, prediction with A/α and B/α under Q_α = γ²Q + (1 − γ²)P and R_α = γ²R. Its Ω is well
    /// conditioned for any horizon.
    Exponential {
        /// α ≥ 1; above 1 the present weighs more than the future.
        alpha: f64,
        /// 0 < λ ≤ 1; below 1 all closed-loop eigenvalues are asked to be smaller than λ.
        lambda: f64,
    },
    /// No discounting, and P, the cost of the regulator of degree λ, as the weight of the state at N_p:
    /// the finite horizon then costs what the infinite one costs. The better choice when constraints are
    /// active, because exponential weighting discounts the future.
    Terminal {
        /// 0 < λ ≤ 1.
        lambda: f64,
    },
}

impl Weighting {
    /// [`Weighting::Exponential`].
    pub fn exponential(alpha: f64, lambda: f64) -> Self {
        Self::Exponential { alpha, lambda }
    }

    /// λ, 1 for the literal recipe.
    pub fn lambda(&self) -> f64 {
        match *self {
            Self::Literal { .. } => 1.0,
            Self::Exponential { lambda, .. } | Self::Terminal { lambda } => lambda,
        }
    }

    /// The cost of the predicted trajectory that this weighting stands for.
    pub(crate) fn stage_cost(&self, weights: &Weights, dlqr: &Dlqr) -> Result<StageCost, DesignError> {
        let (q, r, p) = (weights.q(), weights.r(), dlqr.cost());
        match *self {
            Self::Literal { alpha } => {
                check_alpha(alpha)?;
                Ok(StageCost { alpha, q: q.clone(), r: r.clone(), terminal: None })
            }
            Self::Exponential { alpha, lambda } => {
                check_alpha(alpha)?;
                let gamma = lambda / alpha;
                let gamma_squared = gamma * gamma;
                Ok(StageCost {
                    alpha,
                    // Q_α = γ²Q + (1 − γ²)P
                    q: q * gamma_squared + p * (1.0 - gamma_squared),
                    // R_α = γ²R
                    r: r * gamma_squared,
                    terminal: None,
                })
            }
            Self::Terminal { lambda } => {
                Ok(StageCost { alpha: lambda, q: q.clone(), r: r.clone(), terminal: Some(p.clone()) })
            }
        }
    }
}

pub(crate) fn check_alpha(alpha: f64) -> Result<(), DesignError> {
    if alpha >= 1.0 && alpha.is_finite() { Ok(()) } else { Err(DesignError::Alpha { value: alpha }) }
}

/// Σ x̂ᵀ Q x̂ + Σ Δûᵀ R Δû (+ x̂(N_p)ᵀ P x̂(N_p)) on the prediction model (A/α, B/α) of (53).
#[derive(Clone, Debug)]
pub(crate) struct StageCost {
    pub(crate) alpha: f64,
    pub(crate) q: DMatrix<f64>,
    pub(crate) r: DMatrix<f64>,
    pub(crate) terminal: Option<DMatrix<f64>>,
}
