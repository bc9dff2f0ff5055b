//! Units: what they measure, and how they convert into SI base units.

/// Exponents of kg, m, s, A, K, mol and cd. Angles have none: rad is a number, as SI has it, and exporters differ in whether they
/// count it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dimension(pub [i32; 7]);

/// A unit: value in base units = `factor` · value + `offset`.
#[derive(Clone, Debug, PartialEq)]
pub struct Unit {
    /// Its name.
    pub name: String,
    /// What it measures; `None` if its definition does not say.
    pub dimension: Option<Dimension>,
    /// Factor to base units.
    pub factor: f64,
    /// Offset in base units.
    pub offset: f64,
}

const DEGREE: f64 = std::f64::consts::PI / 180.0;
const TURN_PER_MINUTE: f64 = std::f64::consts::PI / 30.0;

/// Units in common use: names, the first one as it is told to people, what they measure, and their factor to base units.
type Known = (&'static [&'static str], [i32; 7], f64);
#[rustfmt::skip]
const KNOWN: [Known; 23] = [
    (&["rad"], [0; 7], 1.0),
    (&["1", "", "-"], [0; 7], 1.0),
    (&["deg", "°"], [0; 7], DEGREE),
    (&["%"], [0; 7], 0.01),
    (&["m"], [0, 1, 0, 0, 0, 0, 0], 1.0),
    (&["cm"], [0, 1, 0, 0, 0, 0, 0], 0.01),
    (&["mm"], [0, 1, 0, 0, 0, 0, 0], 0.001),
    (&["ft"], [0, 1, 0, 0, 0, 0, 0], 0.3048),
    (&["m/s"], [0, 1, -1, 0, 0, 0, 0], 1.0),
    (&["km/h"], [0, 1, -1, 0, 0, 0, 0], 1.0 / 3.6),
    (&["m/s2", "m/s²"], [0, 1, -2, 0, 0, 0, 0], 1.0),
    (&["rad/s", "1/s"], [0, 0, -1, 0, 0, 0, 0], 1.0),
    (&["deg/s", "°/s"], [0, 0, -1, 0, 0, 0, 0], DEGREE),
    (&["rpm", "rev/min", "1/min"], [0, 0, -1, 0, 0, 0, 0], TURN_PER_MINUTE),
    (&["rad/s2"], [0, 0, -2, 0, 0, 0, 0], 1.0),
    (&["kg"], [1, 0, 0, 0, 0, 0, 0], 1.0),
    (&["g"], [1, 0, 0, 0, 0, 0, 0], 0.001),
    (&["kgm2", "kgm²"], [1, 2, 0, 0, 0, 0, 0], 1.0),
    (&["N"], [1, 1, -2, 0, 0, 0, 0], 1.0),
    (&["Nm"], [1, 2, -2, 0, 0, 0, 0], 1.0),
    (&["s"], [0, 0, 1, 0, 0, 0, 0], 1.0),
    (&["V"], [1, 2, -3, -1, 0, 0, 0], 1.0),
    (&["A"], [0, 0, 0, 1, 0, 0, 0], 1.0),
];

impl Unit {
    /// A unit in common use by its name, for FMUs that name units without defining them.
    pub fn known(name: &str) -> Option<Self> {
        let compact: String =
            name.chars().filter(|letter| !matches!(letter, ' ' | '^' | '*' | '.' | '·')).collect();
        let (_, dimension, factor) = KNOWN.iter().find(|(names, ..)| names.contains(&compact.as_str()))?;
        let dimension = Some(Dimension(*dimension));
        Some(Self { name: name.to_owned(), dimension, factor: *factor, offset: 0.0 })
    }

    /// The names of the units in common use that measure something.
    pub fn known_of(dimension: Dimension) -> impl Iterator<Item = &'static str> {
        let of = KNOWN.iter().filter(move |(_, measured, _)| Dimension(*measured) == dimension);
        of.filter_map(|(names, ..)| names.first().copied())
    }

    /// A value of this unit in base units.
    pub fn to_base(&self, value: f64) -> f64 {
        self.factor * value + self.offset
    }

    /// A value in base units in this one.
    pub fn from_base(&self, value: f64) -> f64 {
        (value - self.offset) / self.factor
    }
}

#[cfg(test)]
mod tests {
    use super::{Dimension, Unit};

    #[test]
    fn known_units_convert_both_ways() {
        for (name, value, base) in [
            ("deg", 180.0, std::f64::consts::PI),
            ("rpm", 60.0, std::f64::consts::TAU),
            ("km/h", 36.0, 10.0),
            ("ft", 1.0, 0.3048),
            ("N.m", 2.0, 2.0),
            ("m/s^2", 9.81, 9.81),
        ] {
            let unit = Unit::known(name).unwrap_or_else(|| panic!("{name}"));
            assert!((unit.to_base(value) - base).abs() < 1e-12, "{name}");
            assert!((unit.from_base(base) - value).abs() < 1e-12, "{name}");
        }
        assert_eq!(
            Unit::known("N*m").and_then(|unit| unit.dimension),
            Some(Dimension([1, 2, -2, 0, 0, 0, 0]))
        );
        assert_eq!(Unit::known("furlong"), None);
        let speeds: Vec<_> = Unit::known_of(Dimension([0, 1, -1, 0, 0, 0, 0])).collect();
        assert_eq!(speeds, ["m/s", "km/h"]);
    }
}
