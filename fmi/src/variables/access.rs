//! Type, range and place of a variable.

use super::{Choice, Quantity, Type, Value};

/// Type, range and place of a variable that can be set, in `T`: the inputs or the parameters of a model.
pub enum Field<T: 'static> {
    /// A real number within [minimum, maximum].
    Real {
        /// Its quantity.
        quantity: &'static Quantity,
        /// Smallest value.
        minimum: f64,
        /// Largest value.
        maximum: f64,
        /// Reads it.
        get: fn(&T) -> f64,
        /// Writes it, unchecked.
        set: fn(&mut T, f64),
    },
    /// An integer within [minimum, maximum].
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
        /// The items.
        choice: Choice,
        /// Reads it.
        get: fn(&T) -> i32,
        /// Writes it.
        set: fn(&mut T, i32),
    },
    /// A Boolean.
    Boolean {
        /// Reads it.
        get: fn(&T) -> bool,
        /// Writes it.
        set: fn(&mut T, bool),
    },
}

/// Type, range and place of a variable that can only be read, in the outputs `T` of a model.
pub enum Signal<T: 'static> {
    /// A real signal.
    Real {
        /// Its quantity.
        quantity: &'static Quantity,
        /// Smallest value, if it has one.
        minimum: Option<f64>,
        /// Largest value, if it has one.
        maximum: Option<f64>,
        /// Reads it.
        get: fn(&T) -> f64,
    },
    /// A count, 0 or more.
    Count {
        /// Reads it.
        get: fn(&T) -> u32,
    },
    /// One of some named items, counted from 1.
    Enumeration {
        /// The items.
        choice: Choice,
        /// Reads it.
        get: fn(&T) -> i32,
    },
    /// A Boolean.
    Boolean {
        /// Reads it.
        get: fn(&T) -> bool,
    },
}

// Not derived: that would ask for `T: Copy`.
impl<T> Clone for Field<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Field<T> {}

impl<T> Clone for Signal<T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Signal<T> {}

/// Smallest and largest value, if there are any.
pub(crate) type Range = (Option<Value>, Option<Value>);

impl<T> Field<T> {
    pub(crate) fn value_type(&self) -> Type {
        match self {
            Self::Real { .. } => Type::Real,
            Self::Integer { .. } => Type::Integer,
            Self::Enumeration { .. } => Type::Enumeration,
            Self::Boolean { .. } => Type::Boolean,
        }
    }

    pub(crate) fn quantity(&self) -> Option<&'static Quantity> {
        if let Self::Real { quantity, .. } = self { Some(quantity) } else { None }
    }

    pub(crate) fn choice(&self) -> Option<&Choice> {
        if let Self::Enumeration { choice, .. } = self { Some(choice) } else { None }
    }

    pub(crate) fn range(&self) -> Range {
        match self {
            Self::Real { minimum, maximum, .. } => (Some(Value::Real(*minimum)), Some(Value::Real(*maximum))),
            Self::Integer { minimum, maximum, .. } => {
                (Some(Value::Integer(*minimum)), Some(Value::Integer(*maximum)))
            }
            Self::Enumeration { choice, .. } => items(choice),
            Self::Boolean { .. } => (None, None),
        }
    }

    /// Its value.
    pub(crate) fn get(&self, from: &T) -> Value {
        match self {
            Self::Real { get, .. } => Value::Real(get(from)),
            Self::Integer { get, .. } | Self::Enumeration { get, .. } => Value::Integer(get(from)),
            Self::Boolean { get, .. } => Value::Boolean(get(from)),
        }
    }

    /// Writes a value of its type, unchecked.
    pub(crate) fn set(&self, into: &mut T, value: Value) {
        match (self, value) {
            (Self::Real { set, .. }, Value::Real(value)) => set(into, value),
            (Self::Integer { set, .. } | Self::Enumeration { set, .. }, Value::Integer(value)) => {
                set(into, value);
            }
            (Self::Boolean { set, .. }, Value::Boolean(value)) => set(into, value),
            _ => {}
        }
    }
}

impl<T> Signal<T> {
    pub(crate) fn value_type(&self) -> Type {
        match self {
            Self::Real { .. } => Type::Real,
            Self::Count { .. } => Type::Integer,
            Self::Enumeration { .. } => Type::Enumeration,
            Self::Boolean { .. } => Type::Boolean,
        }
    }

    pub(crate) fn quantity(&self) -> Option<&'static Quantity> {
        if let Self::Real { quantity, .. } = self { Some(quantity) } else { None }
    }

    pub(crate) fn choice(&self) -> Option<&Choice> {
        if let Self::Enumeration { choice, .. } = self { Some(choice) } else { None }
    }

    pub(crate) fn range(&self) -> Range {
        match self {
            Self::Real { minimum, maximum, .. } => (minimum.map(Value::Real), maximum.map(Value::Real)),
            Self::Count { .. } => (Some(Value::Integer(0)), None),
            Self::Enumeration { choice, .. } => items(choice),
            Self::Boolean { .. } => (None, None),
        }
    }

    /// Its value.
    pub(crate) fn get(&self, from: &T) -> Value {
        match self {
            Self::Real { get, .. } => Value::Real(get(from)),
            Self::Count { get } => Value::Integer(i32::try_from(get(from)).unwrap_or(i32::MAX)),
            Self::Enumeration { get, .. } => Value::Integer(get(from)),
            Self::Boolean { get } => Value::Boolean(get(from)),
        }
    }
}

/// The smallest and the largest number of an item.
fn items(choice: &Choice) -> Range {
    (Some(Value::Integer(1)), i32::try_from(choice.items.len()).ok().map(Value::Integer))
}
