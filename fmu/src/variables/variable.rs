//! One variable of the model.

use std::fmt;

use quadrotor::{Access, CascadeDesign, Configuration, Inputs, Outputs, Parameter};

use super::Quantity;

/// Type of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Type {
    /// `Real`
    Real,
    /// `Integer`
    Integer,
    /// `Boolean`
    Boolean,
}

impl fmt::Display for Type {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Real => "Real",
            Self::Integer => "Integer",
            Self::Boolean => "Boolean",
        })
    }
}

/// A value of a variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// Of a `Real` variable.
    Real(f64),
    /// Of an `Integer` variable.
    Integer(i32),
    /// Of a `Boolean` variable.
    Boolean(bool),
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

/// A real output.
#[derive(Clone, Copy, Debug)]
pub struct Output {
    /// Its quantity.
    pub quantity: Quantity,
    /// Smallest value, if it has one.
    pub minimum: Option<f64>,
    /// Largest value, if it has one.
    pub maximum: Option<f64>,
    /// Names, or beginnings of names, of the inputs and parameters that its initial value depends on.
    pub initially_depends_on: &'static [&'static str],
    /// Reads it.
    pub get: fn(&Outputs) -> f64,
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
            Role::Parameter(Parameter { access: Access::Integer { .. }, .. }) => Type::Integer,
            _ => Type::Real,
        }
    }

    /// Its quantity, if it is a `Real`.
    pub fn quantity(&self) -> Option<Quantity> {
        match self.role {
            Role::Input(Input::Real { quantity, .. }) => Some(quantity),
            Role::Output(output) => Some(output.quantity),
            Role::Parameter(Parameter { name, unit, access: Access::Real { .. }, .. }) => {
                Some(Quantity::of_parameter(name, *unit))
            }
            Role::CalculatedParameter(_) => Some(Quantity::Number),
            Role::Input(Input::Boolean { .. }) | Role::Parameter(_) => None,
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
            Role::Input(Input::Real { .. }) | Role::Output(_) => "continuous",
            Role::Input(Input::Boolean { .. }) => "discrete",
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
            Role::Output(output) => (output.minimum.map(Value::Real), output.maximum.map(Value::Real)),
            Role::Parameter(parameter) => match parameter.access {
                Access::Real { minimum, maximum, .. } => {
                    (Some(Value::Real(minimum)), Some(Value::Real(maximum)))
                }
                Access::Integer { minimum, maximum, .. } => {
                    (Some(Value::Integer(minimum)), Some(Value::Integer(maximum)))
                }
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
        Access::Integer { get, .. } => Value::Integer(get(configuration)),
        Access::Boolean { get, .. } => Value::Boolean(get(configuration)),
    }
}

/// Writes a value of the parameter's type, unchecked.
pub(crate) fn set_parameter(parameter: &Parameter, configuration: &mut Configuration, value: Value) {
    match (parameter.access, value) {
        (Access::Real { set, .. }, Value::Real(value)) => set(configuration, value),
        (Access::Integer { set, .. }, Value::Integer(value)) => set(configuration, value),
        (Access::Boolean { set, .. }, Value::Boolean(value)) => set(configuration, value),
        _ => {}
    }
}
