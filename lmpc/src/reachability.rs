//! Modes that inputs cannot move or outputs do not show.

use alloc::vec::Vec;

use nalgebra::{Complex, DMatrix};

use crate::{DesignError, eigenvalues};

/// Singular values below this share of the matrix norm count as zero.
const RANK_TOLERANCE: f64 = 1e-10;

/// Eigenvalues of the part of (A, B) that B cannot reach, by the staircase algorithm: orthogonal
/// transformations peel off what is reachable in one step, then in two, and so on (Van Dooren 1981).
/// Empty when the pair is controllable.
///
/// # Errors
/// [`DesignError::Eigenvalues`] when the eigenvalues of the remaining block are not found.
pub fn uncontrollable_eigenvalues(
    a: &DMatrix<f64>,
    b: &DMatrix<f64>,
) -> Result<Vec<Complex<f64>>, DesignError> {
    let scale = a.norm().max(f64::MIN_POSITIVE);
    let (mut a_k, mut b_k) = (a.clone(), b.clone());
    let mut tolerance = RANK_TOLERANCE * b.norm();
    loop {
        let size = a_k.nrows();
        // Zero columns make B_k at least square, so that the SVD has a complete orthogonal U.
        let wide = b_k.clone().resize_horizontally(b_k.ncols().max(size), 0.0);
        let svd = wide.svd(true, false);
        let rank = svd.singular_values.iter().filter(|&&s| s > tolerance).count();
        if rank == 0 {
            return eigenvalues("A restricted to what B cannot reach", &a_k);
        }
        if rank == size {
            return Ok(Vec::new());
        }
        let Some(u) = svd.u else {
            return Err(DesignError::Eigenvalues { name: "B" });
        };
        // Uᵀ A U = [A11 A12; A21 A22]: the next pair is (A22, A21).
        let rotated = u.transpose() * &a_k * &u;
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
