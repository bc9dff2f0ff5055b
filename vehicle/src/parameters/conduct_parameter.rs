//! One parameter of the vehicle's behaviour: names, range, meaning, and the field that it reads and writes.

use super::NamedValue;
use crate::identity::Identity;
use crate::vehicle::Conduct;

/// A parameter of the vehicle's behaviour. The table of parameters, the metadata that clients download and the book's tables are
/// made of it.
#[derive(Clone, Copy, Debug)]
pub struct ConductParameter {
    /// Identifier by PX4's convention.
    pub id: &'static str,
    /// ArduPilot's name for the same thing, and how many of its units one of ours is.
    pub ardupilot: Option<(&'static str, f64)>,
    /// Further names of ArduPilot, from before or after a renaming, with their units.
    pub also: &'static [(&'static str, f64)],
    /// Whether only whole numbers are allowed.
    pub integer: bool,
    /// Smallest value, in our units.
    pub minimum: f64,
    /// Largest value, in our units.
    pub maximum: f64,
    /// Reads it.
    pub get: fn(&Conduct) -> f64,
    /// Writes it, unchecked; `false` when the value means nothing.
    pub set: fn(&mut Conduct, f64) -> bool,
    /// Its unit, as PX4 writes it. ArduPilot counts metres in hundredths where the scale says so.
    pub unit: &'static str,
    /// What it is, in a few words.
    pub text: &'static str,
    /// Values that have names, if only those are taken.
    pub names: fn() -> Vec<NamedValue>,
    /// Meanings of the bits, the lowest first, if the value is a sum of them.
    pub bits: &'static [&'static str],
}

impl ConductParameter {
    /// The same under further names of ArduPilot.
    pub(super) const fn also(self, also: &'static [(&'static str, f64)]) -> Self {
        Self { also, ..self }
    }

    /// Its names in the terms of an identity, each with how many of its units one of ours is, and whether it is a further one.
    pub(super) fn names_in(&self, identity: Identity) -> impl Iterator<Item = (&'static str, f64, bool)> {
        let ardupilot = identity.is_ardupilot();
        let (id, scale) = self.ardupilot.filter(|_| ardupilot).unwrap_or((self.id, 1.0));
        let also = if ardupilot { self.also } else { &[] };
        std::iter::once((id, scale, false)).chain(also.iter().map(|(id, scale)| (*id, *scale, true)))
    }
}

/// A number with a unit: identifier, ArduPilot's name, range, field, (scale,) unit, text.
macro_rules! real {
    ($id:literal, $ardupilot:expr, $minimum:literal..=$maximum:literal, $($field:ident).+, $unit:literal, $text:literal) => {
        real!($id, $ardupilot, $minimum..=$maximum, $($field).+, 1.0, $unit, $text)
    };
    ($id:literal, $ardupilot:expr, $minimum:literal..=$maximum:literal, $($field:ident).+, $scale:expr, $unit:literal, $text:literal) => {
        ConductParameter {
            id: $id,
            ardupilot: $ardupilot,
            also: &[],
            integer: false,
            minimum: $minimum,
            maximum: $maximum,
            get: |conduct| conduct.$($field).+ * $scale,
            set: |conduct, value| {
                conduct.$($field).+ = value / $scale;
                true
            },
            unit: $unit,
            text: $text,
            names: Vec::new,
            bits: &[],
        }
    };
}

/// One of a few meanings with numbers and names; the first one stands for what has none.
macro_rules! choice {
    ($id:literal, $meanings:ident, $($field:ident).+, $text:literal) => {
        ConductParameter {
            id: $id,
            ardupilot: None,
            also: &[],
            integer: true,
            minimum: -100.0,
            maximum: 100.0,
            get: |conduct| {
                let meaning = $meanings.iter().find(|(known, ..)| *known == conduct.$($field).+);
                meaning.map_or(0.0, |(_, number, _)| f64::from(*number))
            },
            set: |conduct, value| {
                let meaning = $meanings.iter().find(|(_, number, _)| f64::from(*number) == value);
                if let Some((meaning, ..)) = meaning {
                    conduct.$($field).+ = *meaning;
                }
                meaning.is_some()
            },
            unit: "",
            text: $text,
            names: || {
                let name = |(_, number, name): &(_, i32, &'static str)| crate::parameters::NamedValue::new(*number, name);
                $meanings.iter().map(name).collect()
            },
            bits: &[],
        }
    };
}

/// Off (0) or on (1), or by other names.
macro_rules! switch {
    ($id:literal, $($field:ident).+, $text:literal) => {
        switch!($id, $($field).+, $text, ["Off", "On"])
    };
    ($id:literal, $($field:ident).+, $text:literal, [$off:literal, $on:literal]) => {
        ConductParameter {
            id: $id,
            ardupilot: None,
            also: &[],
            integer: true,
            minimum: 0.0,
            maximum: 1.0,
            get: |conduct| f64::from(u8::from(conduct.$($field).+)),
            set: |conduct, value| {
                let means = value == 0.0 || value == 1.0;
                if means {
                    conduct.$($field).+ = value == 1.0;
                }
                means
            },
            unit: "",
            text: $text,
            names: || {
                let named = crate::parameters::NamedValue::new;
                vec![named(0, $off), named(1, $on)]
            },
            bits: &[],
        }
    };
}

/// A sum of bits with names: how the field is read as one, and made of one.
macro_rules! bitmask {
    ($id:literal, $names:ident, $($field:ident).+, $read:expr, $made:expr, $text:literal) => {
        ConductParameter {
            id: $id,
            ardupilot: None,
            also: &[],
            integer: true,
            minimum: 0.0,
            maximum: ((1_u32 << $names.len()) - 1) as f64,
            get: |conduct| f64::from($read(conduct.$($field).+)),
            set: |conduct, value| {
                let means = value >= 0.0 && value < f64::from(1_u32 << $names.len()) && value.fract() == 0.0;
                if means {
                    conduct.$($field).+ = $made(value as u32);
                }
                means
            },
            unit: "",
            text: $text,
            names: Vec::new,
            bits: $names,
        }
    };
}

/// A whole number: identifier, range, field, its type, text.
macro_rules! whole {
    ($id:literal, $minimum:literal..=$maximum:literal, $($field:ident).+, $kind:ty, $text:literal) => {
        ConductParameter {
            id: $id,
            ardupilot: None,
            also: &[],
            integer: true,
            minimum: $minimum as f64,
            maximum: $maximum as f64,
            get: |conduct| f64::from(conduct.$($field).+),
            set: |conduct, value| {
                let whole = value.fract() == 0.0 && ($minimum as f64..=$maximum as f64).contains(&value);
                if whole {
                    conduct.$($field).+ = value as $kind;
                }
                whole
            },
            unit: "",
            text: $text,
            names: Vec::new,
            bits: &[],
        }
    };
}

pub(super) use {bitmask, choice, real, switch, whole};
