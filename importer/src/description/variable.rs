//! Variables.

use std::fmt;

/// What a variable is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Causality {
    /// Fixed or tunable, set by the importer.
    Parameter,
    /// Follows from parameters.
    CalculatedParameter,
    /// Set by the importer during the simulation.
    Input,
    /// Calculated for others.
    Output,
    /// Calculated.
    Local,
    /// Time.
    Independent,
}

impl fmt::Display for Causality {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Parameter => "parameter",
            Self::CalculatedParameter => "calculated parameter",
            Self::Input => "input",
            Self::Output => "output",
            Self::Local => "local variable",
            Self::Independent => "independent variable",
        })
    }
}

/// When a variable changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variability {
    /// Never.
    Constant,
    /// Not after the initialization.
    Fixed,
    /// When the importer sets it.
    Tunable,
    /// At events.
    Discrete,
    /// Always.
    Continuous,
}

/// The type of a variable.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A double, with the name of its unit.
    Real {
        /// Name of its unit, if it has one.
        unit: Option<String>,
    },
    /// A 32-bit integer.
    Integer,
    /// True or false.
    Boolean,
    /// A text.
    String,
    /// One of several, by its number.
    Enumeration {
        /// Names and numbers of what it chooses from.
        items: Vec<(String, i32)>,
    },
}

impl fmt::Display for Kind {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Real { .. } => "Real",
            Self::Integer => "Integer",
            Self::Boolean => "Boolean",
            Self::String => "String",
            Self::Enumeration { .. } => "Enumeration",
        })
    }
}

/// A scalar variable.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Variable {
    /// Its name.
    pub name: String,
    /// The number that calls have for it.
    pub reference: u32,
    /// What it is for.
    pub causality: Causality,
    /// When it changes.
    pub variability: Variability,
    /// Its type.
    pub kind: Kind,
}

impl Variable {
    /// Whether the importer may set it before or in the initialization.
    pub fn can_be_started(&self) -> bool {
        self.variability != Variability::Constant
            && matches!(self.causality, Causality::Parameter | Causality::Input)
    }
}
