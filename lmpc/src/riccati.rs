//! The discrete algebraic Riccati equation by structure-preserving doubling.

use nalgebra::DMatrix;

use crate::eigenvalues::magnitude;
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
/// [`DesignError::Dimension`], [`DesignError::NotFinite`], [`DesignError::NotSymmetric`],
/// [`DesignError::NotPositiveSemidefinite`] (Q), [`DesignError::NotPositiveDefinite`] (R),
/// [`DesignError::Uncontrollable`] and [`DesignError::Undetectable`] for a mode on or outside the unit
/// circle, [`DesignError::Riccati`] when the residual stays large.
pub fn solve_riccati(
    a: &DMatrix<f64>,
    b: &DMatrix<f64>,
    q: &DMatrix<f64>,
    r: &DMatrix<f64>,
) -> Result<DMatrix<f64>, DesignError> {
    check_preconditions(a, b, q, r)?;
    let r_inverse_b_t = match r.clone().cholesky() {
        Some(factor) => factor.solve(&b.transpose()),
        None => return Err(DesignError::NotPositiveDefinite { name: "R" }),
    };

    let identity = DMatrix::identity(a.nrows(), a.nrows());
    let mut a_k = a.clone();
    let mut g_k = b * r_inverse_b_t;
    let mut h_k = q.clone();
    let mut iterations = 0;
    for doubling in 1..=MAXIMUM_DOUBLINGS {
        iterations = doubling;
        // W = I + G H
        let w = (&identity + &g_k * &h_k).lu();
        let (Some(w_inverse_a), Some(w_inverse_g)) = (w.solve(&a_k), w.solve(&g_k)) else {
            return Err(DesignError::Riccati { residual: f64::INFINITY, iterations });
        };
        // H ← H + Aᵀ H W⁻¹ A,  G ← G + A W⁻¹ G Aᵀ,  A ← A W⁻¹ A
        let increment = a_k.transpose() * &h_k * &w_inverse_a;
        h_k = symmetrized(&(&h_k + &increment));
        g_k = symmetrized(&(&g_k + &a_k * w_inverse_g * a_k.transpose()));
        a_k = &a_k * w_inverse_a;
        if !h_k.iter().all(|value| value.is_finite()) {
            return Err(DesignError::Riccati { residual: f64::INFINITY, iterations });
        }
        if increment.amax() <= f64::EPSILON * h_k.amax() {
            break;
        }
    }

    let p = refined(a, b, q, r, h_k);
    let residual = riccati_residual(a, b, q, r, &p);
    if residual <= RESIDUAL_TOLERANCE { Ok(p) } else { Err(DesignError::Riccati { residual, iterations }) }
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
    let Some(gain) = gain(a, b, r, p) else { return f64::INFINITY };
    let difference = a.transpose() * p * (a - b * gain) + q - p;
    let scale = p.norm().max(q.norm());
    if scale > 0.0 { difference.norm() / scale } else { difference.norm() }
}

/// K = (R + BᵀPB)⁻¹ BᵀPA.
pub(crate) fn gain(
    a: &DMatrix<f64>,
    b: &DMatrix<f64>,
    r: &DMatrix<f64>,
    p: &DMatrix<f64>,
) -> Option<DMatrix<f64>> {
    let b_t_p = b.transpose() * p;
    Some(symmetrized(&(r + &b_t_p * b)).cholesky()?.solve(&(b_t_p * a)))
}

/// One Newton step: P of the closed loop under the gain of `p`; `p` itself if that loop is not stable.
fn refined(
    a: &DMatrix<f64>,
    b: &DMatrix<f64>,
    q: &DMatrix<f64>,
    r: &DMatrix<f64>,
    p: DMatrix<f64>,
) -> DMatrix<f64> {
    let Some(gain) = gain(a, b, r, &p) else { return p };
    let closed_loop_t = (a - b * &gain).transpose();
    let stage_cost = q + gain.transpose() * r * &gain;
    match solve_stein(&closed_loop_t, &closed_loop_t, &stage_cost) {
        Some(newton) => {
            let newton = symmetrized(&newton);
            let better = riccati_residual(a, b, q, r, &newton) < riccati_residual(a, b, q, r, &p);
            if better { newton } else { p }
        }
        None => p,
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
