//! A finished Laguerre MPC design.

use alloc::vec::Vec;

use nalgebra::{Complex, DMatrix};

use crate::laguerre::InputBasis;
use crate::optimal_gain::OptimalGain;
use crate::{
    Augmented, DesignError, Dlqr, LaguerreBasis, Prediction, Weighting, Weights, eigenvalues, spectral_radius,
};

/// Without constraints the optimum η = −Ω⁻¹Ψx (50) makes the first move Δu(k) = L(0)ᵀη = −K x.
///
/// A design is held only if its closed loop is stable; beside it stands the infinite-horizon regulator
/// of the same weights, which it approaches as N grows:
///
/// ```
/// use lmpc::{Augmented, Discretization, LaguerreBasis, LmpcDesign, StateSpace, Weighting, Weights};
/// use nalgebra::{DMatrix, dmatrix};
///
/// // The paper's altitude (9), with its N = 5, a = 0.8187 and α = 1.2.
/// let plant = StateSpace::from_continuous(
///     &dmatrix![0.0, 1.0; 0.0, 0.0],
///     &dmatrix![0.0; 1.0],
///     &dmatrix![1.0, 0.0],
///     0.05,
///     Discretization::ForwardEuler,
/// )?;
/// let augmented = Augmented::new(&plant);
/// let weights = Weights::output(&augmented, 1.0, 1.0)?;
/// let bases = [LaguerreBasis::new(5, 0.8187)?];
/// let design = LmpcDesign::new(&augmented, &weights, &bases, 100, Weighting::exponential(1.2, 1.0))?;
///
/// // Five Laguerre terms already give the gain of the infinite-horizon regulator to 0.1 %.
/// let difference: DMatrix<f64> = design.gain() - design.dlqr().gain();
/// assert!(difference.amax() / design.dlqr().gain().amax() < 1e-3);
/// # Ok::<(), lmpc::DesignError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LmpcDesign {
    gain: DMatrix<f64>,
    /// Ω⁻¹Ψ, ΣN×(n+q).
    coefficient_gain: DMatrix<f64>,
    /// L(0)ᵀ, p×ΣN.
    first_move: DMatrix<f64>,
    prediction: Prediction,
    dlqr: Dlqr,
    closed_loop: DMatrix<f64>,
    spectral_radius: f64,
    condition_number: f64,
    gain_error: f64,
    model: Augmented,
    bases: Vec<LaguerreBasis>,
    alpha: f64,
}

impl LmpcDesign {
    /// Designs the controller of an augmented model with one Laguerre basis per input and a prediction
    /// horizon of N_p = `horizon` samples.
    ///
    /// # Errors
    /// [`DesignError::Unstable`] when the closed loop is not stable, [`DesignError::IllConditioned`] when
    /// rounding may change the gain by more than 10⁻⁴ of its size, and those of [`Dlqr::new`], [`Prediction::new`] and [`Weights::new`].
    pub fn new(
        model: &Augmented,
        weights: &Weights,
        bases: &[LaguerreBasis],
        horizon: usize,
        weighting: Weighting,
    ) -> Result<Self, DesignError> {
        let dlqr = Dlqr::new(model.a(), model.b(), weights.q(), weights.r(), weighting.lambda())?;
        let cost = weighting.stage_cost(weights, &dlqr)?;
        let prediction = Prediction::new(
            &(model.a() / cost.alpha),
            &(model.b() / cost.alpha),
            &cost.q,
            &cost.r,
            bases,
            horizon,
            cost.terminal.as_ref(),
        )?;

        // K = L(0)ᵀ Ω⁻¹ Ψ
        let first_move = InputBasis::new(bases).row();
        let OptimalGain {
            unknowns: coefficient_gain,
            first_move: gain,
            condition: condition_number,
            error: gain_error,
        } = OptimalGain::new("Omega", prediction.omega(), prediction.psi(), &first_move)?;

        let closed_loop = model.a() - model.b() * &gain;
        let spectral_radius = spectral_radius("A − BK", &closed_loop)?;
        // A NaN is refused too.
        if spectral_radius.is_nan() || spectral_radius >= 1.0 {
            return Err(DesignError::Unstable { spectral_radius });
        }
        Ok(Self {
            gain,
            coefficient_gain,
            first_move,
            prediction,
            dlqr,
            closed_loop,
            spectral_radius,
            condition_number,
            gain_error,
            model: model.clone(),
            bases: bases.to_vec(),
            alpha: cost.alpha,
        })
    }

    /// K, p×(n+q): Δu = −K \[Δx_m; y − r\].
    pub fn gain(&self) -> &DMatrix<f64> {
        &self.gain
    }

    /// Ω⁻¹Ψ: without constraints η = −Ω⁻¹Ψx (50).
    pub(crate) fn coefficient_gain(&self) -> &DMatrix<f64> {
        &self.coefficient_gain
    }

    /// L(0)ᵀ: Δu(k) = L(0)ᵀ η.
    pub(crate) fn first_move(&self) -> &DMatrix<f64> {
        &self.first_move
    }

    /// Ω and Ψ.
    pub fn prediction(&self) -> &Prediction {
        &self.prediction
    }

    /// The infinite-horizon regulator of the same weights and degree of stability.
    pub fn dlqr(&self) -> &Dlqr {
        &self.dlqr
    }

    /// The augmented model that it was designed on.
    pub fn model(&self) -> &Augmented {
        &self.model
    }

    /// One Laguerre basis per input.
    pub fn bases(&self) -> &[LaguerreBasis] {
        &self.bases
    }

    /// α of the prediction: the move at sample m is Δu(k+m) = αᵐ L(m)ᵀ η.
    pub fn alpha(&self) -> f64 {
        self.alpha
    }

    /// Eigenvalues of A − BK.
    ///
    /// # Errors
    /// [`DesignError::Eigenvalues`] when the iteration does not converge.
    pub fn closed_loop_eigenvalues(&self) -> Result<Vec<Complex<f64>>, DesignError> {
        eigenvalues("A − BK", &self.closed_loop)
    }

    /// Largest magnitude of the closed-loop eigenvalues, below 1.
    pub fn spectral_radius(&self) -> f64 {
        self.spectral_radius
    }

    /// Condition number of Ω, finite. It bounds what rounding may do to the coefficients; what it does to the gain is
    /// [`LmpcDesign::gain_error`].
    pub fn condition_number(&self) -> f64 {
        self.condition_number
    }

    /// What share of the gain rounding may have changed, at most: an estimate, usually ten times too large.
    pub fn gain_error(&self) -> f64 {
        self.gain_error
    }
}
