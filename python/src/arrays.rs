//! NumPy arrays as matrices and vectors, and back.

use nalgebra::{Complex, DMatrix, DVector};
use numpy::{Complex64, PyArray1, PyArray2, PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::errors::{self, ArgumentError};

/// A matrix from anything that NumPy makes an array of two dimensions of; a number is a 1×1 matrix.
pub fn matrix(name: &str, value: &Bound<'_, PyAny>) -> PyResult<DMatrix<f64>> {
    let array = numbers(name, value)?;
    let numbers = array.readonly();
    let numbers = numbers.as_array();
    let shape = match *array.shape() {
        [] => (1, 1),
        [rows, columns] => (rows, columns),
        ref other => {
            let found = other.len();
            return Err(ArgumentError::new_err(format!(
                "{name} has {found} dimension{}; expected a matrix, which has 2",
                if found == 1 { "" } else { "s" }
            )));
        }
    };
    Ok(DMatrix::from_row_iterator(shape.0, shape.1, numbers.iter().copied()))
}

/// A vector from anything that NumPy makes an array of one dimension of; a number is a vector of one element.
pub fn vector(name: &str, value: &Bound<'_, PyAny>) -> PyResult<DVector<f64>> {
    let array = numbers(name, value)?;
    let numbers = array.readonly();
    let numbers = numbers.as_array();
    if array.shape().len() > 1 {
        return Err(ArgumentError::new_err(format!(
            "{name} has the shape {:?}; expected a vector, which has 1 dimension",
            array.shape()
        )));
    }
    Ok(DVector::from_iterator(numbers.len(), numbers.iter().copied()))
}

/// A vector of so many elements; zeros when it is left out.
pub fn vector_of(name: &str, value: Option<&Bound<'_, PyAny>>, length: usize) -> PyResult<DVector<f64>> {
    let Some(value) = value else { return Ok(DVector::zeros(length)) };
    let vector = vector(name, value)?;
    if vector.len() == length {
        Ok(vector)
    } else {
        Err(ArgumentError::new_err(format!("{name} has {}, expected {length}", elements(vector.len()))))
    }
}

/// So many elements, in words.
pub fn elements(count: usize) -> String {
    format!("{count} element{}", if count == 1 { "" } else { "s" })
}

/// As [`vector_of`], of finite numbers.
pub fn finite_vector_of(
    name: &str,
    value: Option<&Bound<'_, PyAny>>,
    length: usize,
) -> PyResult<DVector<f64>> {
    let vector = vector_of(name, value, length)?;
    check_finite(name, vector.as_slice())?;
    Ok(vector)
}

/// Refuses numbers of an argument of which one is not finite.
pub fn check_finite(name: &str, numbers: &[f64]) -> PyResult<()> {
    match numbers.iter().find(|number| !number.is_finite()) {
        Some(number) => {
            Err(ArgumentError::new_err(format!("{name} contains {number}; expected finite numbers")))
        }
        None => Ok(()),
    }
}

/// Refuses a matrix of which an element is not finite, as designs do.
pub fn check_matrix(name: &'static str, matrix: &DMatrix<f64>) -> PyResult<()> {
    let Some(index) = matrix.iter().position(|number| !number.is_finite()) else { return Ok(()) };
    let (row, column) = matrix.vector_to_matrix_index(index);
    Err(errors::design(&lmpc::DesignError::ElementNotFinite { name, row, column, value: matrix[index] }))
}

fn numbers<'py>(name: &str, value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let python = value.py();
    let wrong = |error: PyErr| {
        ArgumentError::new_err(format!("{name} is no array of numbers: {}", error.value(python)))
    };
    let array = python.import("numpy")?.call_method1("asarray", (value, "float64")).map_err(wrong)?;
    array.cast_into::<PyArrayDyn<f64>>().map_err(|error| wrong(error.into()))
}

/// An array with the elements of a matrix.
pub fn array2<'py>(python: Python<'py>, matrix: &DMatrix<f64>) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let by_row: Vec<f64> = matrix.transpose().iter().copied().collect();
    PyArray1::from_vec(python, by_row).reshape([matrix.nrows(), matrix.ncols()])
}

/// An array with the elements of a vector.
pub fn array1<'py>(python: Python<'py>, vector: &[f64]) -> Bound<'py, PyArray1<f64>> {
    PyArray1::from_slice(python, vector)
}

/// An array of complex numbers.
pub fn complex<'py>(python: Python<'py>, values: &[Complex<f64>]) -> Bound<'py, PyArray1<Complex64>> {
    PyArray1::from_vec(python, values.iter().map(|value| Complex64::new(value.re, value.im)).collect())
}
