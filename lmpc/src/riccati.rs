//! The discrete algebraic Riccati equation by structure-preserving doubling.

use nalgebra::DMatrix;

use crate::eigenvalues::magnitude;
use crate::product::product;
use crate::stein::solve_stein;
use crate::validate::{self, symmetrized};
use crate::{DesignError, uncontrollable_eigenvalues, unobservable_eigenvalues};

/// Doubling squares the closed loop in each step: 2^60 samples reach any horizon of interest.
const MAXIMUM_DOUBLINGS: usize = 60;
/// Largest accepted ‖residual‖ / ‖P‖.
const RESIDUAL_TOLERANCE: f64 = 1e-9;
/// A mode this close below the unit circle may be one on it that rounding has moved.
const UNIT_CIRCLE_MARGIN: f64 = 1e-6;

/// Solves P = AᵀPA − AᵀPB (R + BᵀPB)⁻¹ BᵀPA + Q for the stabilising P ≥ 0: the form of (54).
///
/// Structure-preserving doubling algorithm (Chu, Fan, Lin, Wang 2004, Int. J. Control 77(8), algorithm
/// SDA), then one Newton step (Hewer 1971) which squares the remaining error. A may be singular and Q
/// may be as thin as CᵀC.
///
/// # Errors
/// [`DesignError::Dimension`], [`DesignError::ElementNotFinite`], [`DesignError::NotSymmetric`],
/// [`DesignError::NotPositiveSemidefinite`] (Q), [`DesignError::NotPositiveDefinite`] (R),
/// [`DesignError::Uncontrollable`] and [`DesignError::Undetectable`] for a mode on or outside the unit
/// circle, [`DesignError::Riccati`] when the residual stays large.
pub fn solve_riccati(
    a: &DMatrix<f64>,
    b: &DMatrix<f64>,
    q: &DMatrix<f64>,
    r: &DMatrix<f64>,
) -> Result<DMatrix<f64>, DesignError> {
    Ok(solve(a, b, q, r)?.p)
}

/// A solution of the Riccati equation, or what is to become one.
pub(crate) struct Solution {
    pub(crate) p: DMatrix<f64>,
    /// K = (R + BᵀPB)⁻¹ BᵀPA.
    pub(crate) gain: DMatrix<f64>,
    /// A − B K.
    closed_loop: DMatrix<f64>,
    /// As [`riccati_residual`] has it.
    residual: f64,
}

/// As [`solve_riccati`], with the gain that belongs to P.
pub(crate) fn solve(
    a: &DMatrix<f64>,
    b: &DMatrix<f64>,
    q: &DMatrix<f64>,
    r: &DMatrix<f64>,
) -> Result<Solution, DesignError> {
    check_preconditions(a, b, q, r)?;
    let (p, iterations) = doubled(a, b, q, r)?;
    let failed = |residual| DesignError::Riccati { residual, iterations };
    let solution = Solution::of(a, b, q, r, p).ok_or(failed(f64::INFINITY))?.refined(a, b, q, r);
    if solution.residual <= RESIDUAL_TOLERANCE { Ok(solution) } else { Err(failed(solution.residual)) }
}

/// P by doubling, and how many doublings it took.
fn doubled(
    a: &DMatrix<f64>,
    b: &DMatrix<f64>,
    q: &DMatrix<f64>,
    r: &DMatrix<f64>,
) -> Result<(DMatrix<f64>, usize), DesignError> {
    let r_inverse_b_t = validate::cholesky("R", r)?.solve(&b.transpose());
    let identity = DMatrix::identity(a.nrows(), a.nrows());
    let mut a_k = a.clone();
    let mut g_k = product(b, &r_inverse_b_t);
    let mut h_k = q.clone();
    for iterations in 1..=MAXIMUM_DOUBLINGS {
        // W = I + G H
        let w = (&identity + product(&g_k, &h_k)).lu();
        let (Some(w_inverse_a), Some(w_inverse_g)) = (w.solve(&a_k), w.solve(&g_k)) else {
            return Err(DesignError::Riccati { residual: f64::INFINITY, iterations });
        };
        // H ← H + Aᵀ H W⁻¹ A,  G ← G + A W⁻¹ G Aᵀ,  A ← A W⁻¹ A
        let a_k_t = a_k.transpose();
        let increment = product(&product(&a_k_t, &h_k), &w_inverse_a);
        h_k = symmetrized(&(h_k + &increment));
        if !h_k.iter().all(|value| value.is_finite()) {
            return Err(DesignError::Riccati { residual: f64::INFINITY, iterations });
        }
        if increment.amax() <= f64::EPSILON * h_k.amax() {
            return Ok((h_k, iterations));
        }
        g_k = symmetrized(&(g_k + product(&product(&a_k, &w_inverse_g), &a_k_t)));
        a_k = product(&a_k, &w_inverse_a);
    }
    Ok((h_k, MAXIMUM_DOUBLINGS))
}

/// ‖AᵀPA − AᵀPB (R + BᵀPB)⁻¹ BᵀPA + Q − P‖ / max(‖P‖, ‖Q‖) in the Frobenius norm; infinite when
/// R + BᵀPB cannot be inverted.
pub fn riccati_residual(
    a: &DMatrix<f64>,
    b: &DMatrix<f64>,
    q: &DMatrix<f64>,
    r: &DMatrix<f64>,
    p: &DMatrix<f64>,
) -> f64 {
    Solution::of(a, b, q, r, p.clone()).map_or(f64::INFINITY, |solution| solution.residual)
}

impl Solution {
    /// That of P, unless R + BᵀPB cannot be inverted.
    fn of(
        a: &DMatrix<f64>,
        b: &DMatrix<f64>,
        q: &DMatrix<f64>,
        r: &DMatrix<f64>,
        p: DMatrix<f64>,
    ) -> Option<Self> {
        let b_t_p = product(&b.transpose(), &p);
        let gain = symmetrized(&(r + product(&b_t_p, b))).cholesky()?.solve(&product(&b_t_p, a));
        let closed_loop = a - product(b, &gain);
        let difference = product(&product(&a.transpose(), &p), &closed_loop) + q - &p;
        let scale = p.norm().max(q.norm());
        let residual = if scale > 0.0 { difference.norm() / scale } else { difference.norm() };
        Some(Self { p, gain, closed_loop, residual })
    }

    /// One Newton step: P of the closed loop under its gain; itself if that loop is not stable or P becomes no better.
    fn refined(self, a: &DMatrix<f64>, b: &DMatrix<f64>, q: &DMatrix<f64>, r: &DMatrix<f64>) -> Self {
        let closed_loop_t = self.closed_loop.transpose();
        let stage_cost = q + product(&product(&self.gain.transpose(), r), &self.gain);
        let newton = solve_stein(&closed_loop_t, &closed_loop_t, &stage_cost)
            .and_then(|newton| Self::of(a, b, q, r, symmetrized(&newton)));
        match newton {
            Some(newton) if newton.residual < self.residual => newton,
            _ => self,
        }
    }
}

fn check_preconditions(
    a: &DMatrix<f64>,
    b: &DMatrix<f64>,
    q: &DMatrix<f64>,
    r: &DMatrix<f64>,
) -> Result<(), DesignError> {
    let (n, p) = (a.nrows().max(1), b.ncols().max(1));
    validate::shape("A", a, (n, n))?;
    validate::shape("B", b, (n, p))?;
    validate::shape("Q", q, (n, n))?;
    validate::shape("R", r, (p, p))?;
    validate::positive_semidefinite("Q", q)?;
    validate::positive_definite("R", r)?;

    let on_or_outside = |value: &nalgebra::Complex<f64>| magnitude(*value) >= 1.0 - UNIT_CIRCLE_MARGIN;
    if let Some(mode) = uncontrollable_eigenvalues(a, b)?.into_iter().find(on_or_outside) {
        return Err(DesignError::Uncontrollable { re: mode.re, im: mode.im });
    }
    // Q and its square root have the same null space.
    if let Some(mode) = unobservable_eigenvalues(a, q)?.into_iter().find(on_or_outside) {
        return Err(DesignError::Undetectable { re: mode.re, im: mode.im });
    }
    Ok(())
}
