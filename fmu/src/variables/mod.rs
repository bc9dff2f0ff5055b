//! The one table of variables: a variable's value reference is its place in [`VARIABLES`].

mod calculated;
mod inputs;
mod outputs;
mod quantity;
mod variable;

use quadrotor::PARAMETERS;

pub use quantity::{Quantity, QuantityType};
pub use variable::{CalculatedParameter, Input, Output, Role, Signal, Type, Value, Variable};
pub(crate) use variable::{get_parameter, set_parameter};

use calculated::CALCULATED;
use inputs::INPUTS;
use outputs::OUTPUTS;

use crate::types::ValueReference;

const COUNT: usize = INPUTS.len() + OUTPUTS.len() + PARAMETERS.len() + CALCULATED.len();

/// All variables: inputs, outputs, parameters, calculated parameters. Time is not among them: in
/// co-simulation nobody needs it, and FMI Library wants a start value that FMI 2.0 forbids.
pub static VARIABLES: [Variable; COUNT] = table();

const fn table() -> [Variable; COUNT] {
    let mut table = [INPUTS[0]; COUNT];
    let mut next = 0;
    let mut i = 0;
    while i < INPUTS.len() {
        table[next] = INPUTS[i];
        (next, i) = (next + 1, i + 1);
    }
    i = 0;
    while i < OUTPUTS.len() {
        table[next] = OUTPUTS[i];
        (next, i) = (next + 1, i + 1);
    }
    i = 0;
    while i < PARAMETERS.len() {
        let parameter = &PARAMETERS[i];
        table[next] = Variable {
            name: parameter.name,
            description: parameter.description,
            role: Role::Parameter(parameter),
        };
        (next, i) = (next + 1, i + 1);
    }
    i = 0;
    while i < CALCULATED.len() {
        table[next] = CALCULATED[i];
        (next, i) = (next + 1, i + 1);
    }
    table
}

/// The variable with this value reference.
pub fn variable(reference: ValueReference) -> Option<&'static Variable> {
    VARIABLES.get(usize::try_from(reference).ok()?)
}

/// All variables with their value references.
pub fn with_references() -> impl Iterator<Item = (ValueReference, &'static Variable)> {
    (0..).zip(&VARIABLES)
}
