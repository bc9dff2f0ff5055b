//! Eigenvalues, spectral radius and condition number.

use alloc::vec::Vec;

use nalgebra::linalg::Hessenberg;
use nalgebra::{Complex, DMatrix};

use crate::balancing::balanced;
use crate::hessenberg_qr::hessenberg_eigenvalues;
use crate::{DesignError, validate};

/// All eigenvalues of a square matrix, in the order in which the Schur form has them.
///
/// # Errors
/// [`DesignError::Dimension`] unless it is square, [`DesignError::ElementNotFinite`],
/// [`DesignError::Eigenvalues`] when the iteration does not converge.
pub fn eigenvalues(name: &'static str, matrix: &DMatrix<f64>) -> Result<Vec<Complex<f64>>, DesignError> {
    let size = matrix.nrows();
    validate::shape(name, matrix, (size, size))?;
    if size == 0 {
        return Ok(Vec::new());
    }
    let hessenberg = Hessenberg::new(balanced(matrix.clone())).unpack_h();
    hessenberg_eigenvalues(hessenberg).ok_or(DesignError::Eigenvalues { name })
}

/// Largest magnitude of the eigenvalues.
///
/// # Errors
/// Those of [`eigenvalues`].
pub fn spectral_radius(name: &'static str, matrix: &DMatrix<f64>) -> Result<f64, DesignError> {
    Ok(eigenvalues(name, matrix)?.into_iter().map(magnitude).fold(0.0, f64::max))
}

/// Ratio of the largest to the smallest singular value; infinite for a singular matrix.
pub fn condition_number(matrix: &DMatrix<f64>) -> f64 {
    let singular_values = matrix.singular_values();
    singular_values.max() / singular_values.min()
}

pub(crate) fn magnitude(value: Complex<f64>) -> f64 {
    libm::hypot(value.re, value.im)
}
