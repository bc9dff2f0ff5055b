//! Types and values of variables.

use std::fmt;

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

    /// Its name in FMI 2.0.
    pub fn name(self) -> &'static str {
        match self {
            Self::Real => "Real",
            Self::Integer => "Integer",
            Self::Enumeration => "Enumeration",
            Self::Boolean => "Boolean",
        }
    }
}

impl fmt::Display for Type {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
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
