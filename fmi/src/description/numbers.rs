//! Values as text.

use crate::model::Model;
use crate::variables::{Value, Variable};

/// A value.
pub(super) fn text(value: Value) -> String {
    match value {
        Value::Real(value) => real(value),
        Value::Integer(value) => value.to_string(),
        Value::Boolean(value) => value.to_string(),
    }
}

/// The shortest text that reads back as the same number.
pub(super) fn real(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude == 0.0 || (1e-4..1e7).contains(&magnitude) {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

/// The typical magnitude of a real variable: the start value's of parameters that have one, else the quantity's.
pub(super) fn nominal<M: Model>(variable: &Variable<M>) -> Option<f64> {
    let usual = variable.quantity()?.nominal;
    match (variable.causality(), variable.start()) {
        ("parameter", Some(Value::Real(start))) if start != 0.0 => Some(start.abs()),
        _ => Some(usual),
    }
}

/// Attribute `initial`; inputs need none.
pub(super) fn initial<M: Model>(variable: &Variable<M>) -> Option<&'static str> {
    match variable.causality() {
        "parameter" => Some("exact"),
        "output" | "local" | "calculatedParameter" => Some("calculated"),
        _ => None,
    }
}
