//! The parameters: those of the configuration.

use fmi::variables::{Choice, Field, Role, Variable};
use quadrotor::{Access, Configuration, Mutability, PARAMETERS, Parameter};

use super::ClosedLoop;
use crate::quantities;

const COUNT: usize = PARAMETERS.len();

/// One variable for each number and switch of the configuration.
pub(super) const TABLE: [Variable<ClosedLoop>; COUNT] = table();

const fn table() -> [Variable<ClosedLoop>; COUNT] {
    let mut table = [variable(&PARAMETERS[0]); COUNT];
    let mut i = 1;
    while i < COUNT {
        table[i] = variable(&PARAMETERS[i]);
        i += 1;
    }
    table
}

const fn variable(parameter: &Parameter) -> Variable<ClosedLoop> {
    let tunable = matches!(parameter.mutability, Mutability::Tunable);
    let role = Role::Parameter { tunable, field: field(parameter) };
    Variable { name: parameter.name, description: parameter.description, role }
}

const fn field(parameter: &Parameter) -> Field<Configuration> {
    match parameter.access {
        Access::Real { minimum, maximum, get, set } => {
            let quantity = quantities::of_parameter(parameter.name, parameter.unit);
            Field::Real { quantity, minimum, maximum, get, set }
        }
        Access::Integer { minimum, maximum, get, set } => Field::Integer { minimum, maximum, get, set },
        Access::Enumeration { choice, get, set } => {
            let quadrotor::Choice { name, description, items } = *choice;
            Field::Enumeration { choice: Choice { name, description, items }, get, set }
        }
        Access::Boolean { get, set } => Field::Boolean { get, set },
    }
}
