//! What an FMU says of itself.

mod parse;
mod unit;
mod variable;

pub use unit::{Dimension, Unit};
pub use variable::{Causality, Kind, Variability, Variable};

/// A model description, as far as co-simulation needs it.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelDescription {
    /// Name of the model.
    pub model_name: String,
    /// What its library checks.
    pub guid: String,
    /// Name of its library, without the extension.
    pub model_identifier: String,
    /// Name and version of the tool that made it, if it says.
    pub generation_tool: Option<String>,
    /// Whether steps may be of different lengths.
    pub can_handle_variable_step: bool,
    /// Whether it needs the tool that made it.
    pub needs_execution_tool: bool,
    /// All variables, in the order of the file.
    pub variables: Vec<Variable>,
    /// Definitions of units.
    pub units: Vec<Unit>,
}

impl ModelDescription {
    /// A variable by its exact name.
    pub fn variable(&self, name: &str) -> Option<&Variable> {
        self.variables.iter().find(|variable| variable.name == name)
    }

    /// The definition of a unit.
    pub fn unit(&self, name: &str) -> Option<&Unit> {
        self.units.iter().find(|unit| unit.name == name)
    }
}
