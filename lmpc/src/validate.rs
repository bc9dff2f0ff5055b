//! Checks on matrices that several designs share.

use nalgebra::{Cholesky, DMatrix, Dyn};

use crate::DesignError;

/// Relative deviation from symmetry, and relative negative eigenvalue, that rounding may leave.
const ROUNDING: f64 = 1e-10;

pub(crate) fn shape(
    name: &'static str,
    matrix: &DMatrix<f64>,
    expected: (usize, usize),
) -> Result<(), DesignError> {
    if matrix.shape() != expected {
        return Err(DesignError::Dimension { name, expected, actual: matrix.shape() });
    }
    finite(name, matrix)
}

pub(crate) fn finite(name: &'static str, matrix: &DMatrix<f64>) -> Result<(), DesignError> {
    match matrix.iter().position(|element| !element.is_finite()) {
        None => Ok(()),
        Some(index) => {
            let (row, column) = matrix.vector_to_matrix_index(index);
            Err(DesignError::ElementNotFinite { name, row, column, value: matrix[index] })
        }
    }
}

pub(crate) fn symmetric(name: &'static str, matrix: &DMatrix<f64>) -> Result<(), DesignError> {
    let scale = matrix.amax();
    for column in 0..matrix.ncols() {
        for row in 0..column {
            let difference = (matrix[(row, column)] - matrix[(column, row)]).abs();
            if difference > ROUNDING * scale {
                return Err(DesignError::NotSymmetric { name, row, column, difference });
            }
        }
    }
    Ok(())
}

pub(crate) fn positive_semidefinite(name: &'static str, matrix: &DMatrix<f64>) -> Result<(), DesignError> {
    symmetric(name, matrix)?;
    let smallest = matrix.clone().symmetric_eigenvalues().min();
    if smallest < -ROUNDING * matrix.amax() {
        return Err(DesignError::NotPositiveSemidefinite { name, eigenvalue: smallest });
    }
    Ok(())
}

pub(crate) fn positive_definite(name: &'static str, matrix: &DMatrix<f64>) -> Result<(), DesignError> {
    symmetric(name, matrix)?;
    cholesky(name, matrix).map(drop)
}

/// L of a symmetric matrix L Lᵀ.
///
/// # Errors
/// [`DesignError::NotPositiveDefinite`], [`DesignError::NotFinite`].
pub(crate) fn cholesky(name: &'static str, matrix: &DMatrix<f64>) -> Result<Cholesky<f64, Dyn>, DesignError> {
    matrix.clone().cholesky().ok_or_else(|| not_positive_definite(name, matrix))
}

/// L⁻¹ of a symmetric matrix L Lᵀ.
///
/// # Errors
/// [`DesignError::NotPositiveDefinite`], [`DesignError::NotFinite`].
pub(crate) fn inverse_factor(name: &'static str, matrix: &DMatrix<f64>) -> Result<DMatrix<f64>, DesignError> {
    let size = matrix.nrows();
    let factor = cholesky(name, matrix)?;
    let inverse = factor.l().solve_lower_triangular(&DMatrix::identity(size, size));
    inverse.ok_or_else(|| not_positive_definite(name, matrix))
}

fn not_positive_definite(name: &'static str, matrix: &DMatrix<f64>) -> DesignError {
    if !matrix.iter().all(|element| element.is_finite()) {
        // It has no eigenvalues that could be looked for.
        return DesignError::NotFinite { name };
    }
    DesignError::NotPositiveDefinite { name, eigenvalue: matrix.clone().symmetric_eigenvalues().min() }
}

/// # Errors
/// [`DesignError::SlackCost`] unless it is positive and finite.
pub(crate) fn slack_cost(value: f64) -> Result<(), DesignError> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(DesignError::SlackCost { value }) }
}

/// Removes what rounding has added to a matrix that is symmetric by construction.
pub(crate) fn symmetrized(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    (matrix + matrix.transpose()) * 0.5
}
