//! Numbers and lists as arguments. Errors have the argument's name, its value and what is allowed.

use std::ops::RangeInclusive;

use pyo3::PyClass;
use pyo3::prelude::*;

use crate::errors::ArgumentError;

/// Largest count of terms, moves, bounds, states and inputs that memory is taken for.
pub const MOST: usize = 1000;
/// Largest number of samples that are looked ahead.
pub const MOST_SAMPLES: usize = 10_000;

/// A value as Python shows it; nothing if it cannot be shown.
pub fn shown(value: &Bound<'_, PyAny>) -> String {
    value.repr().map_or_else(|_| String::new(), |shown| shown.to_string())
}

/// The error about an argument that is something else.
fn wrong(name: &str, value: &Bound<'_, PyAny>, expected: &str) -> PyErr {
    ArgumentError::new_err(format!("{name} = {}; expected {expected}", shown(value)))
}

/// A number.
pub fn number(name: &str, value: &Bound<'_, PyAny>) -> PyResult<f64> {
    value.extract().map_err(|_| wrong(name, value, "a number"))
}

/// A number, or another one if it is left out.
pub fn number_or(name: &str, value: Option<&Bound<'_, PyAny>>, otherwise: f64) -> PyResult<f64> {
    value.map_or(Ok(otherwise), |value| number(name, value))
}

/// A number above zero.
pub fn positive(name: &str, value: &Bound<'_, PyAny>) -> PyResult<f64> {
    above_zero(name, number(name, value)?)
}

/// A number that is above zero and finite.
pub fn above_zero(name: &str, number: f64) -> PyResult<f64> {
    if number > 0.0 && number.is_finite() {
        Ok(number)
    } else {
        Err(ArgumentError::new_err(format!("{name} = {number} is outside (0, ∞)")))
    }
}

/// A whole number within a range.
pub fn whole(name: &str, value: &Bound<'_, PyAny>, allowed: RangeInclusive<usize>) -> PyResult<usize> {
    match value.extract::<usize>() {
        Ok(number) if allowed.contains(&number) => Ok(number),
        _ => {
            let (least, most) = allowed.into_inner();
            Err(wrong(name, value, &format!("a whole number from {least} to {most}")))
        }
    }
}

/// Whole numbers within a range, at least one.
pub fn wholes(name: &str, value: &Bound<'_, PyAny>, allowed: RangeInclusive<usize>) -> PyResult<Vec<usize>> {
    let expected = format!("whole numbers from {} to {}, one or more", allowed.start(), allowed.end());
    let items = value.try_iter().map_err(|_| wrong(name, value, &expected))?;
    let number = |item: PyResult<Bound<'_, PyAny>>| {
        let item = item?;
        match item.extract::<usize>() {
            Ok(number) if allowed.contains(&number) => Ok(number),
            _ => Err(ArgumentError::new_err(format!("{name} has {}; expected {expected}", item.repr()?))),
        }
    };
    let numbers = items.map(number).collect::<PyResult<Vec<_>>>()?;
    if numbers.is_empty() { Err(wrong(name, value, &expected)) } else { Ok(numbers) }
}

/// Objects of a class of the package.
pub fn objects<'py, T>(name: &str, value: &Bound<'py, PyAny>, class: &str) -> PyResult<Vec<PyRef<'py, T>>>
where
    T: PyClass,
{
    let expected = format!("a list of {class}");
    let items = value.try_iter().map_err(|_| wrong(name, value, &expected))?;
    let object = |item: PyResult<Bound<'py, PyAny>>| {
        item?.extract::<PyRef<'py, T>>().map_err(|_| wrong(name, value, &expected))
    };
    items.map(object).collect()
}

/// Objects of a class, none if they are left out.
pub fn objects_or_none<'py, T>(
    name: &str,
    value: Option<&Bound<'py, PyAny>>,
    class: &str,
) -> PyResult<Vec<PyRef<'py, T>>>
where
    T: PyClass,
{
    value.map_or_else(|| Ok(Vec::new()), |value| objects(name, value, class))
}
