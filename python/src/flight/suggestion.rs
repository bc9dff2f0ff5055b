//! What somebody probably meant by a name that there is not.

use pyo3::prelude::*;
use quadrotor::{PARAMETERS, nearest_name};

use super::inputs;
use super::outputs;
use crate::errors::ParameterError;

/// The kinds of names, as they are called and with what is done with them.
const KINDS: [(&str, &str); 3] = [
    ("parameter", "it is a parameter: set it among the parameters"),
    ("input", "it is an input: set it among the inputs"),
    ("output", "it is an output, and only read"),
];

/// Whether there is a name of a kind.
fn has(kind: &str, name: &str) -> bool {
    match kind {
        "parameter" => PARAMETERS.iter().any(|parameter| parameter.name == name),
        "input" => inputs::all().any(|input| input.name() == name),
        _ => outputs::all().any(|output| output.name() == name),
    }
}

/// The error about an unknown name of a kind.
pub fn unknown<'a>(kind: &str, name: &str, known: impl IntoIterator<Item = &'a str>) -> PyErr {
    if let Some((_, remedy)) = KINDS.iter().find(|(other, _)| *other != kind && has(other, name)) {
        return ParameterError::new_err(format!("there is no {kind} {name}; {remedy}"));
    }
    let remedy = match nearest_name(name, known) {
        Some(close) => format!("did you mean {close}?"),
        None => format!("`lmpc_quadrotor.{kind}s()` lists all"),
    };
    ParameterError::new_err(format!("there is no {kind} {name}; {remedy}"))
}
