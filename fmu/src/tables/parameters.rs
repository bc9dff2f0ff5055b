//! Parameters of the configuration.

use fmi::Model;
use fmi::variables::{Choice, Field, Role, Variable};
use quadrotor::{Access, Configured, Mutability, Parameter};

use crate::quantities;

/// Which parameters of the configuration a model has. Each entry stands for all names that begin with it: an empty one for all there are.
#[derive(Clone, Copy)]
pub(crate) struct Selection {
    /// Those that it has,
    pub(crate) of: &'static [&'static str],
    /// without these.
    pub(crate) without: &'static [&'static str],
}

impl Selection {
    const fn has(self, name: &str) -> bool {
        begins_with_one_of(name, self.of) && !begins_with_one_of(name, self.without)
    }

    /// How many parameters are selected.
    pub(crate) const fn count<T: Configured>(self) -> usize {
        let (mut count, mut i) = (0, 0);
        while i < T::PARAMETERS.len() {
            count += self.has(T::PARAMETERS[i].name) as usize;
            i += 1;
        }
        count
    }
}

/// One variable for each selected number and switch of the configuration, in its order; `COUNT` is [`Selection::count`].
pub(crate) const fn table<M: Model<Parameters: Configured>, const COUNT: usize>(
    selection: Selection,
) -> [Variable<M>; COUNT] {
    let parameters = <M::Parameters as Configured>::PARAMETERS;
    let mut table = [variable(&parameters[0]); COUNT];
    let (mut selected, mut i) = (0, 0);
    while i < parameters.len() {
        if selection.has(parameters[i].name) {
            table[selected] = variable(&parameters[i]);
            selected += 1;
        }
        i += 1;
    }
    assert!(selected == COUNT, "the table has as many rows as parameters are selected");
    table
}

/// The table with those selected parameters tunable that are fixed where controllers depend on them.
pub(crate) const fn tunable<M: Model, const COUNT: usize>(
    mut table: [Variable<M>; COUNT],
    selection: Selection,
) -> [Variable<M>; COUNT] {
    let mut i = 0;
    while i < COUNT {
        if selection.has(table[i].name)
            && let Role::Parameter { tunable, .. } = &mut table[i].role
        {
            *tunable = true;
        }
        i += 1;
    }
    table
}

const fn variable<M: Model>(parameter: &Parameter<M::Parameters>) -> Variable<M> {
    let tunable = matches!(parameter.mutability, Mutability::Tunable);
    let role = Role::Parameter { tunable, field: field(parameter) };
    Variable { name: parameter.name, description: parameter.description, role }
}

const fn field<T>(parameter: &Parameter<T>) -> Field<T> {
    match &parameter.access {
        Access::Real { minimum, maximum, get, set } => {
            let quantity = quantities::of_parameter(parameter.name, parameter.unit);
            Field::Real { quantity, minimum: *minimum, maximum: *maximum, get: *get, set: *set }
        }
        Access::Integer { minimum, maximum, get, set } => {
            Field::Integer { minimum: *minimum, maximum: *maximum, get: *get, set: *set }
        }
        Access::Enumeration { choice, get, set } => {
            let quadrotor::Choice { name, description, items } = **choice;
            Field::Enumeration { choice: Choice { name, description, items }, get: *get, set: *set }
        }
        Access::Boolean { get, set } => Field::Boolean { get: *get, set: *set },
    }
}

/// `str::starts_with` for constants.
const fn begins_with_one_of(name: &str, beginnings: &[&str]) -> bool {
    let mut i = 0;
    while i < beginnings.len() {
        let (name, beginning) = (name.as_bytes(), beginnings[i].as_bytes());
        let mut same = 0;
        while same < beginning.len() && same < name.len() && beginning[same] == name[same] {
            same += 1;
        }
        if same == beginning.len() {
            return true;
        }
        i += 1;
    }
    false
}

#[cfg(test)]
mod tests {
    use super::begins_with_one_of;

    #[test]
    fn a_name_begins_with_all_of_a_beginning() {
        let name = "airframe.mass";
        for (beginnings, expected) in [
            (&["airframe."][..], true),
            (&["initial.", "airframe.mass"], true),
            (&["airframe.mass_factor"], false),
            (&["frame."], false),
            (&[], false),
            (&[""], true),
        ] {
            assert_eq!(begins_with_one_of(name, beginnings), expected, "{beginnings:?}");
        }
    }
}
