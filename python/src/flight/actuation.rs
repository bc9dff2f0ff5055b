//! What a vehicle is asked for.

use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::errors::ArgumentError;

/// What a vehicle is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Actuation {
    /// A position and what goes with it, of the whole cascade.
    Reference,
    /// Thrust and body rates, of the attitude controller.
    Rates,
    /// Rotor speeds, of the plant alone.
    Rotors,
}

impl Actuation {
    /// By its name.
    pub fn from_name(name: &str) -> PyResult<Self> {
        match name {
            "reference" => Ok(Self::Reference),
            "rates" => Ok(Self::Rates),
            "rotors" => Ok(Self::Rotors),
            other => Err(ArgumentError::new_err(format!(
                "actuation = {other:?}; allowed are 'reference', 'rates' and 'rotors'"
            ))),
        }
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Reference => "reference",
            Self::Rates => "rates",
            Self::Rotors => "rotors",
        }
    }
}
