//! A number or switch of a [`Configuration`], by its public name.

use crate::{Configuration, ConfigurationError, Unit, ValueRange};

/// One parameter of a [`Configuration`], or of settings `T` that contain one ([`Configured`](crate::Configured)).
#[derive(Clone, Copy, Debug)]
pub struct Parameter<T: 'static = Configuration> {
    /// Public name, structured with dots.
    pub name: &'static str,
    /// What it is, for a person.
    pub description: &'static str,
    /// Unit of its value.
    pub unit: Unit,
    /// When a change takes effect.
    pub mutability: Mutability,
    /// Its type, range and place in the configuration.
    pub access: Access<T>,
}

/// When a changed value of a parameter takes effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mutability {
    /// At the next sample: a number that the controllers, the shaper or the sensors read. FMI: tunable.
    Tunable,
    /// At the next sample: it changes the structure of the controllers or the vehicle itself, and the flight is handed over
    /// ([`ControlLoop::hand_over`](crate::ControlLoop::hand_over)). FMI: fixed, because an importer may rely on the structure.
    Structural,
    /// At the next start: it describes how a flight begins. FMI: fixed.
    Start,
}

/// Type, range and place of a parameter in `T`.
#[derive(Clone, Copy, Debug)]
pub enum Access<T: 'static = Configuration> {
    /// A real number within [minimum, maximum].
    Real {
        /// Smallest value.
        minimum: f64,
        /// Largest value.
        maximum: f64,
        /// Reads it.
        get: fn(&T) -> f64,
        /// Writes it, unchecked.
        set: fn(&mut T, f64),
    },
    /// A whole number within [minimum, maximum].
    Integer {
        /// Smallest value.
        minimum: i32,
        /// Largest value.
        maximum: i32,
        /// Reads it.
        get: fn(&T) -> i32,
        /// Writes it, unchecked.
        set: fn(&mut T, i32),
    },
    /// One of some named items, counted from 1.
    Enumeration {
        /// What is chosen.
        choice: &'static Choice,
        /// Reads it.
        get: fn(&T) -> i32,
        /// Writes it; what is no item changes nothing.
        set: fn(&mut T, i32),
    },
    /// A switch.
    Boolean {
        /// Reads it.
        get: fn(&T) -> bool,
        /// Writes it.
        set: fn(&mut T, bool),
    },
}

/// The items of an enumeration, the first of which counts 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Choice {
    /// Name of the enumeration.
    pub name: &'static str,
    /// What it is, for a person.
    pub description: &'static str,
    /// Name and description of each item.
    pub items: &'static [(&'static str, &'static str)],
}

impl Access {
    /// Gives one configuration the value that another one has here.
    pub(crate) fn copy(&self, from: &Configuration, to: &mut Configuration) {
        match *self {
            Self::Real { get, set, .. } => set(to, get(from)),
            Self::Integer { get, set, .. } => set(to, get(from)),
            Self::Enumeration { get, set, .. } => set(to, get(from)),
            Self::Boolean { get, set } => set(to, get(from)),
        }
    }

    /// Whether both configurations have the same value here.
    pub(crate) fn same(&self, one: &Configuration, other: &Configuration) -> bool {
        match *self {
            Self::Real { get, .. } => get(one) == get(other),
            Self::Integer { get, .. } => get(one) == get(other),
            Self::Enumeration { get, .. } => get(one) == get(other),
            Self::Boolean { get, .. } => get(one) == get(other),
        }
    }

    /// The bits of the value that a configuration has here: those of a zero tell its sign.
    pub(crate) fn bits(&self, configuration: &Configuration) -> u64 {
        match *self {
            Self::Real { get, .. } => get(configuration).to_bits(),
            Self::Integer { get, .. } | Self::Enumeration { get, .. } => {
                u64::from(get(configuration).cast_unsigned())
            }
            Self::Boolean { get, .. } => u64::from(get(configuration)),
        }
    }
}

impl Parameter {
    /// Checks the value that a configuration has for this parameter against its range.
    ///
    /// # Errors
    /// [`ConfigurationError::OutOfRange`] with the name, the value and the range.
    pub fn check(&self, configuration: &Configuration) -> Result<(), ConfigurationError> {
        let (value, minimum, maximum) = match self.access {
            Access::Real { minimum, maximum, get, .. } => (get(configuration), minimum, maximum),
            Access::Integer { minimum, maximum, get, .. } => {
                (f64::from(get(configuration)), f64::from(minimum), f64::from(maximum))
            }
            // Only items can be stored.
            Access::Enumeration { .. } | Access::Boolean { .. } => return Ok(()),
        };
        let range = ValueRange { minimum, maximum, unit: self.unit.symbol() };
        if range.contains(value) {
            Ok(())
        } else {
            Err(ConfigurationError::OutOfRange { name: self.name, value, range })
        }
    }
}
