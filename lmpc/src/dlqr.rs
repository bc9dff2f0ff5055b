//! The infinite-horizon linear quadratic regulator, the limit that LMPC is held against.

use nalgebra::DMatrix;

use crate::riccati::gain;
use crate::{DesignError, solve_riccati};

/// Discrete linear quadratic regulator Δu = −K x with a prescribed degree of stability.
///
/// Minimises Σ λ^(−2j) (xᵀQx + ΔuᵀRΔu), so that every closed-loop eigenvalue has a magnitude below λ
/// (Anderson and Moore 1971); λ = 1 is the ordinary regulator.
#[derive(Clone, Debug, PartialEq)]
pub struct Dlqr {
    gain: DMatrix<f64>,
    cost: DMatrix<f64>,
    lambda: f64,
}

impl Dlqr {
    /// For x(k+1) = A x + B Δu, weights Q ≥ 0 and R > 0, degree of stability 0 < λ ≤ 1.
    ///
    /// # Errors
    /// [`DesignError::Lambda`], and those of [`solve_riccati`].
    pub fn new(
        a: &DMatrix<f64>,
        b: &DMatrix<f64>,
        q: &DMatrix<f64>,
        r: &DMatrix<f64>,
        lambda: f64,
    ) -> Result<Self, DesignError> {
        if !(lambda > 0.0 && lambda <= 1.0) {
            return Err(DesignError::Lambda { value: lambda });
        }
        // P solves the Riccati equation of (A/λ, B/λ, Q, R)
        let (a_scaled, b_scaled) = (a / lambda, b / lambda);
        let cost = solve_riccati(&a_scaled, &b_scaled, q, r)?;
        // K = (R + λ⁻² BᵀPB)⁻¹ λ⁻² BᵀPA: the form of (54)
        let gain = gain(&a_scaled, &b_scaled, r, &cost)
            .ok_or(DesignError::NotPositiveDefinite { name: "R + BᵀPB" })?;
        Ok(Self { gain, cost, lambda })
    }

    /// K, p×n: Δu = −K x.
    pub fn gain(&self) -> &DMatrix<f64> {
        &self.gain
    }

    /// P, n×n: the cost from state x on is xᵀPx.
    pub fn cost(&self) -> &DMatrix<f64> {
        &self.cost
    }

    /// λ, the degree of stability it was designed for.
    pub fn lambda(&self) -> f64 {
        self.lambda
    }
}
