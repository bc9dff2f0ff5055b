//! The exceptions that the package raises.

use lmpc::DesignError as Refusal;
use pyo3::create_exception;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;

create_exception!(
    lmpc_quadrotor,
    ArgumentError,
    PyValueError,
    "An argument has a wrong shape, name or value. The message names the argument and what is allowed."
);
create_exception!(
    lmpc_quadrotor,
    DesignError,
    PyValueError,
    "A controller or estimator cannot be designed. The message names the argument or matrix, its value and what is allowed."
);
create_exception!(
    lmpc_quadrotor,
    ParameterError,
    PyValueError,
    "A parameter or input of a flight is unknown or out of range. The message has its name, its value and the allowed range."
);
create_exception!(
    lmpc_quadrotor,
    FlightError,
    PyRuntimeError,
    "A flight cannot go on, for instance because its motion has diverged."
);

/// A refused design as an exception that begins with the argument that is to blame, where that is one.
pub fn design(refusal: &Refusal) -> PyErr {
    match argument_of(refusal) {
        Some(argument) => DesignError::new_err(format!("{argument}: {refusal}")),
        None => DesignError::new_err(refusal.to_string()),
    }
}

/// As [`design`], with the arguments whose matrices the formulas call otherwise: pairs of a formula's name and an argument's.
pub fn design_of(refusal: &Refusal, names: &[(&str, &str)]) -> PyErr {
    let text = refusal.to_string();
    let named = names.iter().find_map(|(symbol, argument)| {
        let rest = text.strip_prefix(symbol)?.strip_prefix(' ')?;
        Some(format!("{argument} ({symbol}) {rest}"))
    });
    named.map_or_else(|| design(refusal), DesignError::new_err)
}

/// The argument, as the Python functions call it.
fn argument_of(refusal: &Refusal) -> Option<&'static str> {
    Some(match refusal {
        Refusal::SampleTime { .. } => "sample_time",
        Refusal::NoLaguerreTerms => "terms",
        Refusal::LaguerreScale { .. } | Refusal::LaguerreDecay { .. } => "scale",
        Refusal::ControlHorizon { .. } => "control_horizon",
        Refusal::BasisCount { .. } => "bases",
        Refusal::HorizonTooShort { .. } => "horizon",
        Refusal::MovesBeyondHorizon { .. } => "moves",
        Refusal::Alpha { .. } => "alpha",
        Refusal::Lambda { .. } => "degree",
        _ => return None,
    })
}

/// Puts the exceptions into the module.
pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let python = module.py();
    module.add("ArgumentError", python.get_type::<ArgumentError>())?;
    module.add("DesignError", python.get_type::<DesignError>())?;
    module.add("ParameterError", python.get_type::<ParameterError>())?;
    module.add("FlightError", python.get_type::<FlightError>())
}
