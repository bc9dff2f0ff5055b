//! One variable of the model.

use std::fmt;

use quadrotor::{Access, CascadeDesign, Choice, Configuration, Inputs, Outputs, Parameter};

use super::Quantity;

/// Type of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Type {
    /// `Real`
    Real,
    /// `Integer`
    Integer,
    /// `Enumeration`, which the interface reads and writes as `Integer`
    Enumeration,
    /// `Boolean`
    Boolean,
}

impl Type {
    /// The type by which the functions of the interface know it.
    pub fn of_functions(self) -> Self {
        if self == Self::Enumeration { Self::Integer } else { self }
    }
}

impl fmt::Display for Type {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Real => "Real",
            Self::Integer => "Integer",
            Self::Enumeration => "Enumeration",
            Self::Boolean => "Boolean",
        })
    }
}

/// A value of a variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// Of a `Real` variable.
    Real(f64),
    /// Of an `Integer` or `Enumeration` variable.
    Integer(i32),
    /// Of a `Boolean` variable.
    Boolean(bool),
}

impl fmt::Display for Value {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            // The shortest digits that read back as the same number, with a point.
            Self::Real(value) => write!(formatter, "{value:?}"),
            Self::Integer(value) => write!(formatter, "{value}"),
            Self::Boolean(value) => write!(formatter, "{value}"),
        }
    }
}

/// One variable: everything that the library and its description say about it.
#[derive(Clone, Copy, Debug)]
pub struct Variable {
    /// Structured name.
    pub name: &'static str,
    /// What it is, for a person.
    pub description: &'static str,
    /// What the model does with it.
    pub role: Role,
}

/// What the model does with a variable.
#[derive(Clone, Copy, Debug)]
pub enum Role {
    /// Comes from outside at communication points.
    Input(Input),
    /// Can be observed.
    Output(Output),
    /// Part of the configuration.
    Parameter(&'static Parameter),
    /// Follows from the configuration.
    CalculatedParameter(CalculatedParameter),
}

/// Type, range and place of an input.
#[derive(Clone, Copy, Debug)]
pub enum Input {
    /// A real signal within [minimum, maximum].
    Real {
        /// Its quantity.
        quantity: Quantity,
        /// Smallest value.
        minimum: f64,
        /// Largest value.
        maximum: f64,
        /// Reads it.
        get: fn(&Inputs) -> f64,
        /// Writes it, unchecked.
        set: fn(&mut Inputs, f64),
    },
    /// A switch.
    Boolean {
        /// Reads it.
        get: fn(&Inputs) -> bool,
        /// Writes it.
        set: fn(&mut Inputs, bool),
    },
}

/// An output.
#[derive(Clone, Copy, Debug)]
pub struct Output {
    /// Names, or beginnings of names, of the inputs and parameters that its initial value depends on.
    pub initially_depends_on: &'static [&'static str],
    /// Type, range and place.
    pub signal: Signal,
}

/// Type, range and place of an output.
#[derive(Clone, Copy, Debug)]
pub enum Signal {
    /// A real signal.
    Real {
        /// Its quantity.
        quantity: Quantity,
        /// Smallest value, if it has one.
        minimum: Option<f64>,
        /// Largest value, if it has one.
        maximum: Option<f64>,
        /// Reads it.
        get: fn(&Outputs) -> f64,
    },
    /// A count, 0 or more.
    Count {
        /// Reads it.
        get: fn(&Outputs) -> u32,
    },
    /// One of some named items, counted from 1.
    Enumeration {
        /// The items.
        choice: &'static Choice,
        /// Reads it.
        get: fn(&Outputs) -> i32,
    },
}

/// A figure of a controller's design.
#[derive(Clone, Copy, Debug)]
pub struct CalculatedParameter {
    /// Names, or beginnings of names, of the parameters that it depends on.
    pub depends_on: &'static [&'static str],
    /// Reads it.
    pub get: fn(&CascadeDesign) -> f64,
}

impl Variable {
    /// Its type.
    pub fn value_type(&self) -> Type {
        match self.role {
            Role::Input(Input::Boolean { .. }) => Type::Boolean,
            Role::Parameter(Parameter { access: Access::Boolean { .. }, .. }) => Type::Boolean,
            Role::Parameter(Parameter { access: Access::Integer { .. }, .. })
            | Role::Output(Output { signal: Signal::Count { .. }, .. }) => Type::Integer,
            Role::Parameter(Parameter { access: Access::Enumeration { .. }, .. })
            | Role::Output(Output { signal: Signal::Enumeration { .. }, .. }) => Type::Enumeration,
            _ => Type::Real,
        }
    }

    /// Its quantity, if it is a `Real`.
    pub fn quantity(&self) -> Option<Quantity> {
        match self.role {
            Role::Input(Input::Real { quantity, .. }) => Some(quantity),
            Role::Output(Output { signal: Signal::Real { quantity, .. }, .. }) => Some(quantity),
            Role::Parameter(Parameter { name, unit, access: Access::Real { .. }, .. }) => {
                Some(Quantity::of_parameter(name, *unit))
            }
            Role::CalculatedParameter(_) => Some(Quantity::Number),
            Role::Input(Input::Boolean { .. }) | Role::Output(_) | Role::Parameter(_) => None,
        }
    }

    /// What it is chosen from, if it is an `Enumeration`.
    pub fn choice(&self) -> Option<&'static Choice> {
        match self.role {
            Role::Parameter(Parameter { access: Access::Enumeration { choice, .. }, .. }) => Some(*choice),
            Role::Output(Output { signal: Signal::Enumeration { choice, .. }, .. }) => Some(choice),
            _ => None,
        }
    }

    /// Attribute `causality` of the description.
    pub fn causality(&self) -> &'static str {
        match self.role {
            Role::Input(_) => "input",
            Role::Output(_) => "output",
            Role::Parameter(_) => "parameter",
            Role::CalculatedParameter(_) => "calculatedParameter",
        }
    }

    /// Attribute `variability` of the description.
    pub fn variability(&self) -> &'static str {
        match self.role {
            Role::Input(Input::Real { .. }) | Role::Output(Output { signal: Signal::Real { .. }, .. }) => {
                "continuous"
            }
            Role::Input(Input::Boolean { .. }) | Role::Output(_) => "discrete",
            Role::Parameter(parameter) if !parameter.tunable => "fixed",
            // They follow from tunable weights.
            Role::Parameter(_) | Role::CalculatedParameter(_) => "tunable",
        }
    }

    /// Its smallest and largest value, as far as they are limited.
    pub fn range(&self) -> (Option<Value>, Option<Value>) {
        match self.role {
            Role::Input(Input::Real { minimum, maximum, .. }) => {
                (Some(Value::Real(minimum)), Some(Value::Real(maximum)))
            }
            Role::Output(Output { signal, .. }) => match signal {
                Signal::Real { minimum, maximum, .. } => (minimum.map(Value::Real), maximum.map(Value::Real)),
                Signal::Count { .. } => (Some(Value::Integer(0)), None),
                Signal::Enumeration { choice, .. } => items(choice),
            },
            Role::Parameter(parameter) => match parameter.access {
                Access::Real { minimum, maximum, .. } => {
                    (Some(Value::Real(minimum)), Some(Value::Real(maximum)))
                }
                Access::Integer { minimum, maximum, .. } => {
                    (Some(Value::Integer(minimum)), Some(Value::Integer(maximum)))
                }
                Access::Enumeration { choice, .. } => items(choice),
                Access::Boolean { .. } => (None, None),
            },
            Role::Input(Input::Boolean { .. }) | Role::CalculatedParameter(_) => (None, None),
        }
    }

    /// Its start value, if it has one: inputs and parameters do.
    pub fn start(&self) -> Option<Value> {
        match self.role {
            Role::Input(input) => Some(input.get(&Inputs::default())),
            Role::Parameter(parameter) => Some(get_parameter(parameter, &Configuration::default())),
            _ => None,
        }
    }

    /// What its initial value depends on, as names or beginnings of names, if it is an unknown.
    pub fn initially_depends_on(&self) -> Option<&'static [&'static str]> {
        match self.role {
            Role::Output(output) => Some(output.initially_depends_on),
            Role::CalculatedParameter(calculated) => Some(calculated.depends_on),
            _ => None,
        }
    }
}

/// The smallest and the largest number of an item.
fn items(choice: &Choice) -> (Option<Value>, Option<Value>) {
    (Some(Value::Integer(1)), i32::try_from(choice.items.len()).ok().map(Value::Integer))
}

impl Output {
    /// Its value.
    pub(crate) fn get(&self, outputs: &Outputs) -> Value {
        match self.signal {
            Signal::Real { get, .. } => Value::Real(get(outputs)),
            Signal::Count { get } => Value::Integer(i32::try_from(get(outputs)).unwrap_or(i32::MAX)),
            Signal::Enumeration { get, .. } => Value::Integer(get(outputs)),
        }
    }
}

impl Input {
    /// Its value.
    pub(crate) fn get(&self, inputs: &Inputs) -> Value {
        match self {
            Self::Real { get, .. } => Value::Real(get(inputs)),
            Self::Boolean { get, .. } => Value::Boolean(get(inputs)),
        }
    }

    /// Writes a value of its type, unchecked.
    pub(crate) fn set(&self, inputs: &mut Inputs, value: Value) {
        match (self, value) {
            (Self::Real { set, .. }, Value::Real(value)) => set(inputs, value),
            (Self::Boolean { set, .. }, Value::Boolean(value)) => set(inputs, value),
            _ => {}
        }
    }
}

/// The value of a parameter.
pub(crate) fn get_parameter(parameter: &Parameter, configuration: &Configuration) -> Value {
    match parameter.access {
        Access::Real { get, .. } => Value::Real(get(configuration)),
        Access::Integer { get, .. } | Access::Enumeration { get, .. } => Value::Integer(get(configuration)),
        Access::Boolean { get, .. } => Value::Boolean(get(configuration)),
    }
}

/// Writes a value of the parameter's type, unchecked.
pub(crate) fn set_parameter(parameter: &Parameter, configuration: &mut Configuration, value: Value) {
    match (parameter.access, value) {
        (Access::Real { set, .. }, Value::Real(value)) => set(configuration, value),
        (Access::Integer { set, .. } | Access::Enumeration { set, .. }, Value::Integer(value)) => {
            set(configuration, value);
        }
        (Access::Boolean { set, .. }, Value::Boolean(value)) => set(configuration, value),
        _ => {}
    }
}
