//! What somebody probably meant by a name that there is not.

use pyo3::prelude::*;

use crate::errors::ParameterError;

/// The error about an unknown name of a kind.
pub fn unknown(python: Python<'_>, kind: &str, name: &str, known: &[&'static str]) -> PyErr {
    let close = python
        .import("difflib")
        .and_then(|difflib| difflib.call_method1("get_close_matches", (name, known.to_vec(), 1)))
        .and_then(|found| found.extract::<Vec<String>>())
        .unwrap_or_default();
    let remedy = match close.first() {
        Some(close) => format!("did you mean {close}?"),
        None => format!("`lmpc_quadrotor.{kind}s()` lists all"),
    };
    ParameterError::new_err(format!("there is no {kind} {name}; {remedy}"))
}
