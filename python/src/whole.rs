//! Whole numbers as arguments.

use pyo3::prelude::*;

use crate::errors::ArgumentError;

/// A whole number, 0 or more. Python adds the argument's name to the error as a note.
pub struct Whole(pub usize);

impl<'a, 'py> FromPyObject<'a, 'py> for Whole {
    type Error = PyErr;

    fn extract(value: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        value.extract::<usize>().map(Self).map_err(|_| {
            let shown = value.repr().map_or_else(|_| String::new(), |shown| shown.to_string());
            ArgumentError::new_err(format!("{shown} is not allowed; expected a whole number, 0 or more"))
        })
    }
}

impl Whole {
    /// Several of them.
    pub fn all(numbers: Vec<Self>) -> Vec<usize> {
        numbers.into_iter().map(|number| number.0).collect()
    }
}
