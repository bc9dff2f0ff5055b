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

const fn of(exponents: [i32; 7], factor: f64) -> (Dimension, f64) {
    (Dimension(exponents), factor)
}

const DEGREE: f64 = std::f64::consts::PI / 180.0;
const TURN_PER_MINUTE: f64 = std::f64::consts::PI / 30.0;

impl Unit {
    /// A unit in common use by its name, for FMUs that name units without defining them.
    pub fn known(name: &str) -> Option<Self> {
        let compact: String =
            name.chars().filter(|letter| !matches!(letter, ' ' | '^' | '*' | '.' | '·')).collect();
        let (dimension, factor) = match compact.as_str() {
            "1" | "" | "-" | "rad" => of([0; 7], 1.0),
            "deg" | "°" => of([0; 7], DEGREE),
            "%" => of([0; 7], 0.01),
            "m" => of([0, 1, 0, 0, 0, 0, 0], 1.0),
            "cm" => of([0, 1, 0, 0, 0, 0, 0], 0.01),
            "mm" => of([0, 1, 0, 0, 0, 0, 0], 0.001),
            "ft" => of([0, 1, 0, 0, 0, 0, 0], 0.3048),
            "m/s" => of([0, 1, -1, 0, 0, 0, 0], 1.0),
            "km/h" => of([0, 1, -1, 0, 0, 0, 0], 1.0 / 3.6),
            "m/s2" | "m/s²" => of([0, 1, -2, 0, 0, 0, 0], 1.0),
            "rad/s" | "1/s" => of([0, 0, -1, 0, 0, 0, 0], 1.0),
            "deg/s" | "°/s" => of([0, 0, -1, 0, 0, 0, 0], DEGREE),
            "rpm" | "rev/min" | "1/min" => of([0, 0, -1, 0, 0, 0, 0], TURN_PER_MINUTE),
            "rad/s2" => of([0, 0, -2, 0, 0, 0, 0], 1.0),
            "kg" => of([1, 0, 0, 0, 0, 0, 0], 1.0),
            "g" => of([1, 0, 0, 0, 0, 0, 0], 0.001),
            "kgm2" => of([1, 2, 0, 0, 0, 0, 0], 1.0),
            "N" => of([1, 1, -2, 0, 0, 0, 0], 1.0),
            "Nm" => of([1, 2, -2, 0, 0, 0, 0], 1.0),
            "s" => of([0, 0, 1, 0, 0, 0, 0], 1.0),
            "V" => of([1, 2, -3, -1, 0, 0, 0], 1.0),
            "A" => of([0, 0, 0, 1, 0, 0, 0], 1.0),
            _ => return None,
        };
        Some(Self { name: name.to_owned(), dimension: Some(dimension), factor, offset: 0.0 })
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
    }
}
