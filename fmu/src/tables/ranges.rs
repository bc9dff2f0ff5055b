//! Ranges in messages: as the vehicle and the Python package tell them.

use fmi::Model;
use fmi::variables::Variable;
use quadrotor::{PARAMETERS, ValueRange};

/// The symbol of a variable's unit in messages: of a parameter that of its row, of anything else that of its description.
fn symbol<M: Model>(variable: &Variable<M>) -> &'static str {
    match PARAMETERS.iter().find(|parameter| parameter.name == variable.name) {
        Some(parameter) => parameter.unit.symbol(),
        None => variable.quantity().and_then(|quantity| quantity.unit).map_or("", |unit| unit.name),
    }
}

/// A number that a variable cannot have, and the range that it must be in.
pub(crate) fn out_of_range<M: Model>(
    variable: &Variable<M>,
    value: f64,
    minimum: f64,
    maximum: f64,
) -> (String, String) {
    let range = ValueRange { minimum, maximum, unit: symbol(variable) };
    (range.quantity(value).to_string(), range.to_string())
}
