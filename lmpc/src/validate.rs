//! Checks on matrices that several designs share.

use nalgebra::DMatrix;

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
    if matrix.iter().all(|x| x.is_finite()) { Ok(()) } else { Err(DesignError::NotFinite { name }) }
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
    if matrix.clone().cholesky().is_none() {
        return Err(DesignError::NotPositiveDefinite { name });
    }
    Ok(())
}

/// Removes what rounding has added to a matrix that is symmetric by construction.
pub(crate) fn symmetrized(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    (matrix + matrix.transpose()) * 0.5
}
