//! A field of a message: name, type, unit, multiplier and value in one row.

use crate::flight_log::LogSource;

/// A field.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// Its label.
    pub name: &'static str,
    /// Its type: a letter of the format.
    pub kind: char,
    /// Its unit: a letter of the table of units.
    pub unit: char,
    /// What a stored number is multiplied with: a letter of the table of multipliers.
    pub multiplier: char,
    /// Its value, in the unit that readers show: those that scale by their type (c, C, e, E: hundredths; L: 1e-7°) undo that.
    pub value: fn(&LogSource<'_>) -> f64,
}

/// A row of a table of fields.
pub const fn field(
    name: &'static str,
    kind: char,
    unit: char,
    multiplier: char,
    value: fn(&LogSource<'_>) -> f64,
) -> Field {
    Field { name, kind, unit, multiplier, value }
}

/// The number of an instance: there is one of each instrument.
pub const fn instance(name: &'static str) -> Field {
    field(name, 'B', '#', '-', |_| 0.0)
}

impl Field {
    /// Bytes of its type.
    pub fn size(kind: char) -> usize {
        match kind {
            'b' | 'B' | 'M' => 1,
            'h' | 'H' | 'c' | 'C' => 2,
            'i' | 'I' | 'e' | 'E' | 'L' | 'f' | 'n' => 4,
            'd' | 'q' | 'Q' => 8,
            'N' => 16,
            'Z' => 64,
            _ => 0,
        }
    }

    /// Appends a value of a type; what is out of its range is the nearest that is within, and what is no number is zero where it must be
    /// whole.
    pub fn put(into: &mut Vec<u8>, kind: char, value: f64) {
        let scaled = match kind {
            'c' | 'C' | 'e' | 'E' => value * 100.0,
            'L' => value * 1e7,
            _ => value,
        };
        let whole = scaled.round();
        match kind {
            'b' => into.extend((whole as i8).to_le_bytes()),
            'B' | 'M' => into.extend((whole as u8).to_le_bytes()),
            'h' | 'c' => into.extend((whole as i16).to_le_bytes()),
            'H' | 'C' => into.extend((whole as u16).to_le_bytes()),
            'i' | 'e' | 'L' => into.extend((whole as i32).to_le_bytes()),
            'I' | 'E' => into.extend((whole as u32).to_le_bytes()),
            'f' => into.extend((value as f32).to_le_bytes()),
            'd' => into.extend(value.to_le_bytes()),
            'q' => into.extend((whole as i64).to_le_bytes()),
            'Q' => into.extend((whole as u64).to_le_bytes()),
            _ => {}
        }
    }
}
