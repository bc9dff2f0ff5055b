//! Functions of matrices.

use numpy::{Complex64, PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::arrays::{array2, check_matrix, complex, matrix};
use crate::errors::{self, ArgumentError, DesignError};

type Matrix<'py> = Bound<'py, PyArray2<f64>>;
type Eigenvalues<'py> = Bound<'py, PyArray1<Complex64>>;

/// The stabilizing solution P, n×n, of P = AᵀPA − AᵀPB (R + BᵀPB)⁻¹ BᵀPA + Q.
#[pyfunction]
fn solve_riccati<'py>(
    python: Python<'py>,
    a: &Bound<'py, PyAny>,
    b: &Bound<'py, PyAny>,
    q: &Bound<'py, PyAny>,
    r: &Bound<'py, PyAny>,
) -> PyResult<Matrix<'py>> {
    let (a, b, q, r) = (matrix("a", a)?, matrix("b", b)?, matrix("q", q)?, matrix("r", r)?);
    let p =
        python.detach(|| lmpc::solve_riccati(&a, &b, &q, &r)).map_err(|refusal| errors::design(&refusal))?;
    array2(python, &p)
}

/// X of X = A X Bᵀ + C for stable A and B.
#[pyfunction]
fn solve_stein<'py>(
    python: Python<'py>,
    a: &Bound<'py, PyAny>,
    b: &Bound<'py, PyAny>,
    c: &Bound<'py, PyAny>,
) -> PyResult<Matrix<'py>> {
    let (a, b, c) = (matrix("a", a)?, matrix("b", b)?, matrix("c", c)?);
    for (name, given, expected) in [
        ("a", a.shape(), (a.nrows(), a.nrows())),
        ("b", b.shape(), (b.nrows(), b.nrows())),
        ("c", c.shape(), (a.nrows(), b.nrows())),
    ] {
        if given != expected {
            let refusal = lmpc::DesignError::Dimension { name, expected, actual: given };
            return Err(errors::design(&refusal));
        }
    }
    let solution = lmpc::solve_stein(&a, &b, &c).ok_or_else(|| {
        DesignError::new_err("a, b: the sum does not converge; every product of their eigenvalues must be below 1 in magnitude")
    })?;
    array2(python, &solution)
}

/// All eigenvalues of a square matrix.
#[pyfunction]
fn eigenvalues<'py>(python: Python<'py>, a: &Bound<'py, PyAny>) -> PyResult<Eigenvalues<'py>> {
    let found = lmpc::eigenvalues("a", &matrix("a", a)?).map_err(|refusal| errors::design(&refusal))?;
    Ok(complex(python, &found))
}

/// The largest magnitude of the eigenvalues of a square matrix.
#[pyfunction]
fn spectral_radius(a: &Bound<'_, PyAny>) -> PyResult<f64> {
    lmpc::spectral_radius("a", &matrix("a", a)?).map_err(|refusal| errors::design(&refusal))
}

/// The ratio of the largest to the smallest singular value; infinite for a matrix without full rank.
#[pyfunction]
fn condition_number(a: &Bound<'_, PyAny>) -> PyResult<f64> {
    let a = matrix("a", a)?;
    check_matrix("a", &a)?;
    if a.is_empty() {
        let (rows, columns) = a.shape();
        return Err(ArgumentError::new_err(format!(
            "a is {rows}×{columns}; expected a row and a column at least"
        )));
    }
    // 0/0 of a matrix without a direction that it keeps.
    let ratio = lmpc::condition_number(&a);
    Ok(if ratio.is_nan() { f64::INFINITY } else { ratio })
}

/// Eigenvalues of the part of (A, B) that B cannot reach; none when the pair is controllable.
#[pyfunction]
fn uncontrollable_eigenvalues<'py>(
    python: Python<'py>,
    a: &Bound<'py, PyAny>,
    b: &Bound<'py, PyAny>,
) -> PyResult<Eigenvalues<'py>> {
    let found = lmpc::uncontrollable_eigenvalues(&matrix("a", a)?, &matrix("b", b)?);
    Ok(complex(python, &found.map_err(|refusal| errors::design(&refusal))?))
}

/// Eigenvalues of the part of (A, C) that C does not show; none when the pair is observable.
#[pyfunction]
fn unobservable_eigenvalues<'py>(
    python: Python<'py>,
    a: &Bound<'py, PyAny>,
    c: &Bound<'py, PyAny>,
) -> PyResult<Eigenvalues<'py>> {
    let (a, c) = (matrix("a", a)?, matrix("c", c)?);
    if c.ncols() != a.nrows() {
        let (expected, actual) = ((c.nrows(), a.nrows()), c.shape());
        return Err(errors::design(&lmpc::DesignError::Dimension { name: "C", expected, actual }));
    }
    let found = lmpc::unobservable_eigenvalues(&a, &c);
    Ok(complex(python, &found.map_err(|refusal| errors::design(&refusal))?))
}

pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(solve_riccati, module)?)?;
    module.add_function(wrap_pyfunction!(solve_stein, module)?)?;
    module.add_function(wrap_pyfunction!(eigenvalues, module)?)?;
    module.add_function(wrap_pyfunction!(spectral_radius, module)?)?;
    module.add_function(wrap_pyfunction!(condition_number, module)?)?;
    module.add_function(wrap_pyfunction!(uncontrollable_eigenvalues, module)?)?;
    module.add_function(wrap_pyfunction!(unobservable_eigenvalues, module)?)
}
