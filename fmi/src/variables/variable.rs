//! One variable of a model.

use super::access::Range;
use super::allowed;
use super::{Choice, Field, Quantity, Signal, Type, Value};
use crate::error::CallError;
use crate::model::Model;

/// Place of a variable in the table of its model.
pub type ValueReference = u32;

/// One variable: everything that the library and its description say about it.
pub struct Variable<M: Model> {
    /// Structured name.
    pub name: &'static str,
    /// Human-readable description.
    pub description: &'static str,
    /// What the model does with it.
    pub role: Role<M>,
}

/// What the model does with a variable.
pub enum Role<M: Model> {
    /// Set by the importer at communication points.
    Input(Field<M::Inputs>),
    /// Read by the importer.
    Output {
        /// The inputs and parameters that its initial value depends on. Each entry stands for all variables whose names
        /// begin with it. The description lists them under `InitialUnknowns`.
        initially_depends_on: &'static [&'static str],
        /// Type, range and place.
        signal: Signal<M::Outputs>,
    },
    /// Set before the run.
    Parameter {
        /// Whether it may change during the run.
        tunable: bool,
        /// Type, range and place.
        field: Field<M::Parameters>,
    },
    /// A parameter that is an enumeration, as an integer: 0 leaves it to the enumeration, a number of an item wins over it. For importers
    /// that know no enumerations.
    Number {
        /// Name of the enumeration.
        of: &'static str,
    },
    /// The time derivative of an output that is a state of [`Continuous`](crate::Continuous).
    Derivative {
        /// Name of the state.
        of: &'static str,
        /// The inputs and parameters that its initial value depends on, as for outputs.
        initially_depends_on: &'static [&'static str],
        /// Its quantity.
        quantity: &'static Quantity,
        /// Reads it.
        get: fn(&M::Outputs) -> f64,
    },
    /// A number that is computed from parameters.
    CalculatedParameter {
        /// The parameters that it depends on. Each entry stands for all whose names begin with it.
        depends_on: &'static [&'static str],
        /// Its quantity.
        quantity: &'static Quantity,
        /// Reads it.
        get: fn(&M) -> f64,
    },
}

// Not derived: that would ask for `M: Copy`.
impl<M: Model> Clone for Variable<M> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<M: Model> Copy for Variable<M> {}

impl<M: Model> Clone for Role<M> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<M: Model> Copy for Role<M> {}

impl<M: Model> Variable<M> {
    /// An input.
    pub const fn input(name: &'static str, description: &'static str, field: Field<M::Inputs>) -> Self {
        Self { name, description, role: Role::Input(field) }
    }

    /// An output, with the names, or beginnings of names, of the inputs and parameters that its initial value depends
    /// on.
    pub const fn output(
        name: &'static str,
        description: &'static str,
        initially_depends_on: &'static [&'static str],
        signal: Signal<M::Outputs>,
    ) -> Self {
        Self { name, description, role: Role::Output { initially_depends_on, signal } }
    }

    /// The time derivative of the output with the name `of`, which is a state.
    pub const fn derivative(
        name: &'static str,
        description: &'static str,
        of: &'static str,
        initially_depends_on: &'static [&'static str],
        quantity: &'static Quantity,
        get: fn(&M::Outputs) -> f64,
    ) -> Self {
        Self { name, description, role: Role::Derivative { of, initially_depends_on, quantity, get } }
    }

    /// A parameter that is fixed during the run.
    pub const fn fixed(name: &'static str, description: &'static str, field: Field<M::Parameters>) -> Self {
        Self { name, description, role: Role::Parameter { tunable: false, field } }
    }

    /// A parameter that may change during the run.
    pub const fn tunable(name: &'static str, description: &'static str, field: Field<M::Parameters>) -> Self {
        Self { name, description, role: Role::Parameter { tunable: true, field } }
    }

    /// The number of the item of the parameter `of`, which is an enumeration; 0 leaves the choice to that parameter.
    pub const fn number(name: &'static str, description: &'static str, of: &'static str) -> Self {
        Self { name, description, role: Role::Number { of } }
    }

    /// A number that is computed from parameters, with their names, or beginnings of names.
    pub const fn calculated(
        name: &'static str,
        description: &'static str,
        depends_on: &'static [&'static str],
        quantity: &'static Quantity,
        get: fn(&M) -> f64,
    ) -> Self {
        Self { name, description, role: Role::CalculatedParameter { depends_on, quantity, get } }
    }

    /// Its type.
    pub fn value_type(&self) -> Type {
        match &self.role {
            Role::Input(field) => field.value_type(),
            Role::Output { signal, .. } => signal.value_type(),
            Role::Parameter { field, .. } => field.value_type(),
            Role::Number { .. } => Type::Integer,
            Role::Derivative { .. } | Role::CalculatedParameter { .. } => Type::Real,
        }
    }

    /// Its quantity, if it is a `Real`.
    pub fn quantity(&self) -> Option<&'static Quantity> {
        match &self.role {
            Role::Input(field) => field.quantity(),
            Role::Output { signal, .. } => signal.quantity(),
            Role::Parameter { field, .. } => field.quantity(),
            Role::Number { .. } => None,
            Role::Derivative { quantity, .. } | Role::CalculatedParameter { quantity, .. } => Some(quantity),
        }
    }

    /// Its items, if it is an `Enumeration`.
    pub fn choice(&self) -> Option<&Choice> {
        match &self.role {
            Role::Input(field) => field.choice(),
            Role::Output { signal, .. } => signal.choice(),
            Role::Parameter { field, .. } => field.choice(),
            Role::Number { .. } => None,
            Role::Derivative { .. } | Role::CalculatedParameter { .. } => None,
        }
    }

    /// Attribute `causality` of the description.
    pub fn causality(&self) -> &'static str {
        match self.role {
            Role::Input(_) => "input",
            Role::Output { .. } => "output",
            Role::Parameter { .. } | Role::Number { .. } => "parameter",
            Role::Derivative { .. } => "local",
            Role::CalculatedParameter { .. } => "calculatedParameter",
        }
    }

    /// Attribute `variability` of the description.
    pub fn variability(&self) -> &'static str {
        match self.role {
            Role::Input(_) | Role::Output { .. } if self.value_type() == Type::Real => "continuous",
            Role::Derivative { .. } => "continuous",
            Role::Input(_) | Role::Output { .. } => "discrete",
            Role::Parameter { tunable: false, .. } => "fixed",
            Role::Number { of } => named::<M>(of).map_or("fixed", |(_, other)| other.variability()),
            // They may follow from tunable parameters.
            Role::Parameter { tunable: true, .. } | Role::CalculatedParameter { .. } => "tunable",
        }
    }

    /// Its smallest and largest value, if it has them.
    pub fn range(&self) -> (Option<Value>, Option<Value>) {
        match &self.role {
            Role::Input(field) => field.range(),
            Role::Output { signal, .. } => signal.range(),
            Role::Parameter { field, .. } => field.range(),
            Role::Number { of } => {
                let items = named::<M>(of).and_then(|(_, other)| other.range().1);
                (Some(Value::Integer(0)), items)
            }
            Role::Derivative { .. } | Role::CalculatedParameter { .. } => (None, None),
        }
    }

    /// Its start value, if it has one: inputs and parameters do.
    pub fn start(&self) -> Option<Value> {
        match &self.role {
            Role::Input(field) => Some(field.get(&M::Inputs::default())),
            Role::Parameter { field, .. } => Some(field.get(&M::Parameters::default())),
            Role::Number { .. } => Some(Value::Integer(0)),
            Role::Output { .. } | Role::Derivative { .. } | Role::CalculatedParameter { .. } => None,
        }
    }

    /// What its initial value depends on, as names or beginnings of names, if it is an unknown.
    pub fn initially_depends_on(&self) -> Option<&'static [&'static str]> {
        match self.role {
            Role::Output { initially_depends_on, .. } | Role::Derivative { initially_depends_on, .. } => {
                Some(initially_depends_on)
            }
            Role::CalculatedParameter { depends_on, .. } => Some(depends_on),
            Role::Input(_) | Role::Parameter { .. } | Role::Number { .. } => None,
        }
    }

    /// Rejects a value below the smallest or above the largest one, and NaN.
    pub(crate) fn check_range(&self, value: Value) -> Result<(), CallError> {
        let number = |value| match value {
            Value::Real(value) => Some(value),
            Value::Integer(value) => Some(f64::from(value)),
            Value::Boolean(_) => None,
        };
        let (Some(minimum), Some(maximum)): Range = self.range() else { return Ok(()) };
        match (number(value), number(minimum), number(maximum)) {
            (Some(given), Some(least), Some(most)) if !(least..=most).contains(&given) => {
                let (value, allowed) = match self.choice() {
                    Some(choice) => (value.to_string(), allowed::items(choice)),
                    None => M::out_of_range(self, given, least, most),
                };
                Err(CallError::OutOfRange { name: self.name, value, allowed })
            }
            _ => Ok(()),
        }
    }
}

/// The variable with this name.
pub(crate) fn named<M: Model>(name: &str) -> Option<(ValueReference, &'static Variable<M>)> {
    variables::<M>().find(|(_, variable)| variable.name == name)
}

/// All variables of a model with their value references.
pub(crate) fn variables<M: Model>() -> impl Iterator<Item = (ValueReference, &'static Variable<M>)> {
    (0..).zip(M::VARIABLES.iter().copied().flatten())
}

/// The variable with this value reference.
pub(crate) fn variable<M: Model>(reference: ValueReference) -> Result<&'static Variable<M>, CallError> {
    match found::<M>(reference) {
        Some(variable) => Ok(variable),
        None => Err(CallError::UnknownReference { reference }),
    }
}

/// The variable with this value reference, if there is one.
#[inline]
pub(crate) fn found<M: Model>(reference: ValueReference) -> Option<&'static Variable<M>> {
    let mut place = usize::try_from(reference).unwrap_or(usize::MAX);
    for group in M::VARIABLES {
        match group.get(place) {
            Some(variable) => return Some(variable),
            None => place -= group.len(),
        }
    }
    None
}
