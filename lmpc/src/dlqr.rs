//! The infinite-horizon linear quadratic regulator, the limit that LMPC is held against.

use nalgebra::DMatrix;

use crate::DesignError;
use crate::riccati;
use crate::weighting::check_alpha;

/// Discrete linear quadratic regulator Δu = −K x with a prescribed degree of stability.
///
/// Minimises Σ λ^(−2j) (xᵀQx + ΔuᵀRΔu), so that every closed-loop eigenvalue has a magnitude below λ
/// (Anderson and Moore 1971); λ = 1 is the ordinary regulator.
#[derive(Clone, Debug, PartialEq)]
pub struct Dlqr {
    gain: DMatrix<f64>,
    cost: DMatrix<f64>,
    radius: f64,
}

impl Dlqr {
    /// For x(k+1) = A x + B Δu, weights Q ≥ 0 and R > 0, degree of stability 0 < λ ≤ 1.
    ///
    /// # Errors
    /// [`DesignError::Lambda`], and those of [`solve_riccati`](crate::solve_riccati).
    pub fn new(
        a: &DMatrix<f64>,
        b: &DMatrix<f64>,
        q: &DMatrix<f64>,
        r: &DMatrix<f64>,
        lambda: f64,
    ) -> Result<Self, DesignError> {
        check_lambda(lambda)?;
        Self::of_radius(a, b, q, r, lambda)
    }

    /// K_w and P_w of (54): minimises J_w (51), Σ α^(−2j) (xᵀQx + ΔuᵀRΔu), of which the future weighs less than the present,
    /// for an infinite horizon, α ≥ 1. It is what a Laguerre MPC of many terms over a long horizon with
    /// [`Weighting::Literal`](crate::Weighting::Literal) has as its gain.
    ///
    /// The optimum stabilises x̂(j) = α^(−j) x(j) (53), (55), whose cost is a plain sum. Of x itself that says only that it
    /// grows more slowly than αʲ: |λ| < α for every eigenvalue of A − B K_w (56)–(57). With α > 1 the loop need not be
    /// stable; check its [spectral radius](crate::spectral_radius). For α = 1 it is [`Dlqr::new`] with λ = 1. The regulator
    /// of [`Weighting::Exponential`](crate::Weighting::Exponential) is stable whatever α, because it transforms Q and R as
    /// well.
    ///
    /// Only modes on or outside the circle of radius α must be controllable and observable through Q.
    ///
    /// # Errors
    /// [`DesignError::Alpha`], and those of [`solve_riccati`](crate::solve_riccati).
    pub fn exponentially_weighted(
        a: &DMatrix<f64>,
        b: &DMatrix<f64>,
        q: &DMatrix<f64>,
        r: &DMatrix<f64>,
        alpha: f64,
    ) -> Result<Self, DesignError> {
        check_alpha(alpha)?;
        Self::of_radius(a, b, q, r, alpha)
    }

    /// The regulator that keeps all eigenvalues inside the circle of that radius.
    fn of_radius(
        a: &DMatrix<f64>,
        b: &DMatrix<f64>,
        q: &DMatrix<f64>,
        r: &DMatrix<f64>,
        radius: f64,
    ) -> Result<Self, DesignError> {
        // P solves the Riccati equation of (A/ρ, B/ρ, Q, R)
        let (a_scaled, b_scaled) = (a / radius, b / radius);
        let solution = riccati::solve(&a_scaled, &b_scaled, q, r)?;
        // K = (R + ρ⁻² BᵀPB)⁻¹ ρ⁻² BᵀPA: (54)
        Ok(Self { gain: solution.gain, cost: solution.p, radius })
    }

    /// K, p×n: Δu = −K x.
    pub fn gain(&self) -> &DMatrix<f64> {
        &self.gain
    }

    /// P, n×n: the cost from state x on is xᵀPx.
    pub fn cost(&self) -> &DMatrix<f64> {
        &self.cost
    }

    /// What every closed-loop eigenvalue is smaller than: the λ or α that it was designed for.
    pub fn radius(&self) -> f64 {
        self.radius
    }
}

/// A degree of stability is 0 < λ ≤ 1.
pub(crate) fn check_lambda(lambda: f64) -> Result<(), DesignError> {
    if lambda > 0.0 && lambda <= 1.0 { Ok(()) } else { Err(DesignError::Lambda { value: lambda }) }
}
