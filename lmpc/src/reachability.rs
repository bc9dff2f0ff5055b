//! Modes that inputs cannot move or outputs do not show.

use alloc::vec::Vec;

use nalgebra::{Complex, DMatrix};

use crate::product::product;
use crate::unit_scaling::UnitScaling;
use crate::{DesignError, eigenvalues, validate};

/// Pivots below this share of the norm of the scaled matrix count as zero.
const RANK_TOLERANCE: f64 = 1e-10;

/// Eigenvalues of the part of (A, B) that B cannot reach, by the staircase algorithm: orthogonal
/// transformations peel off what is reachable in one step, then in two, and so on (Van Dooren 1981).
/// Empty when the pair is controllable.
///
/// The pair is scaled before, so that the answer does not depend on the units of the states and inputs. An element that is
/// zero must be zero exactly: in some unit any other one is large. Only what is rounding beside the elements around
/// it does not count.
///
/// # Errors
/// [`DesignError::Dimension`], [`DesignError::ElementNotFinite`], [`DesignError::Eigenvalues`] when the eigenvalues of the
/// remaining block are not found.
pub fn uncontrollable_eigenvalues(
    a: &DMatrix<f64>,
    b: &DMatrix<f64>,
) -> Result<Vec<Complex<f64>>, DesignError> {
    validate::shape("A", a, (a.nrows(), a.nrows()))?;
    validate::shape("B", b, (a.nrows(), b.ncols()))?;
    let UnitScaling { a, b, rest } = UnitScaling::new(a, b);
    let mut found = eigenvalues("A restricted to what B cannot reach", &rest)?;
    found.extend(staircase(a, b)?);
    Ok(found)
}

/// The eigenvalues that are left when everything reachable has been peeled off a scaled pair.
fn staircase(a: DMatrix<f64>, b: DMatrix<f64>) -> Result<Vec<Complex<f64>>, DesignError> {
    let scale = a.norm();
    let mut tolerance = RANK_TOLERANCE * b.norm();
    let (mut a_k, mut b_k) = (a, b);
    loop {
        let size = a_k.nrows();
        if size == 0 {
            return Ok(Vec::new());
        }
        // Zero columns make B_k at least square, so that Q is square. (The U of nalgebra's SVD is not orthogonal for
        // some matrices of low rank.)
        let factors = b_k.clone().resize_horizontally(b_k.ncols().max(size), 0.0).col_piv_qr();
        let (q, r) = (factors.q(), factors.r());
        let rank = (0..size).take_while(|&i| libm::fabs(r[(i, i)]) > tolerance).count();
        if rank == 0 {
            return eigenvalues("A restricted to what B cannot reach", &a_k);
        }
        // Qᵀ A Q = [A11 A12; A21 A22]: the next pair is (A22, A21).
        let rotated = product(&product(&q.transpose(), &a_k), &q);
        let rest = size - rank;
        b_k = rotated.view((rank, 0), (rest, rank)).into_owned();
        a_k = rotated.view((rank, rank), (rest, rest)).into_owned();
        tolerance = RANK_TOLERANCE * scale;
    }
}

/// Eigenvalues of the part of (A, C) that C does not show: the dual of
/// [`uncontrollable_eigenvalues`]. Empty when the pair is observable.
///
/// # Errors
/// As there.
pub fn unobservable_eigenvalues(
    a: &DMatrix<f64>,
    c: &DMatrix<f64>,
) -> Result<Vec<Complex<f64>>, DesignError> {
    uncontrollable_eigenvalues(&a.transpose(), &c.transpose())
}
