//! Numbers with units, as messages show them.

use core::fmt::{Display, Formatter, Result};

/// A number with the symbol of its unit: `45 rad`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity {
    /// The number.
    pub value: f64,
    /// Symbol of its unit; empty for a dimensionless number.
    pub unit: &'static str,
}

/// A closed range with the symbol of its unit: `0.05–1.2 rad (3°–69°)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValueRange {
    /// Smallest value.
    pub minimum: f64,
    /// Largest value.
    pub maximum: f64,
    /// Symbol of the unit of both; empty for dimensionless numbers.
    pub unit: &'static str,
}

impl ValueRange {
    /// Whether a value is in the range; NaN is in none.
    pub fn contains(&self, value: f64) -> bool {
        (self.minimum..=self.maximum).contains(&value)
    }

    /// A number in the unit of the range.
    pub fn quantity(&self, value: f64) -> Quantity {
        Quantity { value, unit: self.unit }
    }
}

/// A number in the shortest form that reads back as the same: as single precision where it has no more, and is not a count.
struct Short(f64);

/// Up to here every whole number is a double.
const WHOLE: f64 = 9_007_199_254_740_992.0;

impl Display for Short {
    fn fmt(&self, to: &mut Formatter<'_>) -> Result {
        let magnitude = libm::fabs(self.0);
        let scientific = self.0.is_finite() && magnitude != 0.0 && !(1e-3..1e6).contains(&magnitude);
        let single = self.0 as f32;
        let counts = magnitude < WHOLE && libm::trunc(self.0) == self.0;
        match (f64::from(single) == self.0 && !counts, scientific) {
            (true, true) => write!(to, "{single:e}"),
            (true, false) => write!(to, "{single}"),
            (false, true) => write!(to, "{:e}", self.0),
            (false, false) => write!(to, "{}", self.0),
        }
    }
}

impl Display for Quantity {
    fn fmt(&self, to: &mut Formatter<'_>) -> Result {
        Short(self.value).fmt(to)?;
        if self.unit.is_empty() { Ok(()) } else { write!(to, " {}", self.unit) }
    }
}

impl Display for ValueRange {
    fn fmt(&self, to: &mut Formatter<'_>) -> Result {
        // A dash before a sign is hard to read.
        let dash = if self.minimum < 0.0 { " to " } else { "–" };
        write!(to, "{}{dash}{}", Short(self.minimum), self.quantity(self.maximum))?;
        if self.unit == "rad" {
            let degrees = |value: f64| libm::round(value.to_degrees());
            write!(to, " ({}°{dash}{}°)", degrees(self.minimum), degrees(self.maximum))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    extern crate alloc;
    use alloc::string::ToString;

    use super::ValueRange;

    #[test]
    fn ranges_and_values_read_with_their_units() {
        for (minimum, maximum, unit, value, expected) in [
            (0.05, 1.2, "rad", 45.0, "45 rad; 0.05–1.2 rad (3°–69°)"),
            (-6.3, 6.3, "rad", 7.0, "7 rad; -6.3 to 6.3 rad (-361° to 361°)"),
            (1e-9, 1e9, "", f64::NAN, "NaN; 1e-9–1e9"),
            (0.005, 50.0, "kg", f64::from(0.001_f32), "0.001 kg; 0.005–50 kg"),
            (0.0, 3.0, "", 4.0, "4; 0–3"),
            (0.0, 2_147_483_647.0, "", -2_147_483_648.0, "-2.147483648e9; 0–2.147483647e9"),
            (0.0, 1.0, "", f64::from(f32::MAX), "3.4028235e38; 0–1"),
        ] {
            let range = ValueRange { minimum, maximum, unit };
            assert!(!range.contains(value));
            let shown = [range.quantity(value).to_string(), range.to_string()].join("; ");
            assert_eq!(shown, expected);
        }
    }
}
