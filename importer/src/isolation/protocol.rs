//! What goes through the pipes.

use std::fmt;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

/// A value that a variable starts with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum StartValue {
    /// Of a real variable.
    Real(f64),
    /// Of an integer or an enumeration.
    Integer(i32),
    /// Of a boolean variable.
    Boolean(bool),
    /// Of a string variable.
    Text(String),
}

impl fmt::Display for StartValue {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Real(value) => value.fmt(formatter),
            Self::Integer(value) => value.fmt(formatter),
            Self::Boolean(value) => value.fmt(formatter),
            Self::Text(value) => write!(formatter, "{value:?}"),
        }
    }
}

/// To the host.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) enum Request {
    /// Loads the library and initializes an instance.
    Start(Box<Start>),
    /// Sets the inputs and simulates one step.
    Step { time_s: f64, step_s: f64, reals: Vec<f64>, booleans: Vec<bool> },
    /// Terminates and frees the instance.
    Finish,
}

/// What an instance begins with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Start {
    pub(super) preload: Vec<PathBuf>,
    pub(super) library: PathBuf,
    pub(super) guid: String,
    pub(super) resources: String,
    pub(super) name: String,
    pub(super) debug: bool,
    pub(super) slip: PathBuf,
    pub(super) values: Vec<(u32, StartValue)>,
    /// Inputs of each step, and their values in the initialization.
    pub(super) reals: Vec<(u32, f64)>,
    pub(super) booleans: Vec<(u32, bool)>,
    /// Real variables that are read after each step.
    pub(super) outputs: Vec<u32>,
}

/// From the host.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) enum Response {
    /// Values of the outputs.
    Values(Vec<f64>),
    /// Why it could not be done, as a sentence's end.
    Failed(String),
    /// The instance is freed.
    Finished,
}
