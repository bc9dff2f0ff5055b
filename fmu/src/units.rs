//! Units of the variables, by their exponents of SI base units.
//!
//! The first display unit is the one that people read: FMPy plots all variables of a unit in it, whatever display unit their
//! type has. Metres, metres per second and newtons are read as they are.

use std::f64::consts::PI;

use fmi::variables::Unit;

const DEGREES: f64 = 180.0 / PI;
const TURNS_PER_MINUTE: f64 = 30.0 / PI;

const fn unit(
    name: &'static str,
    base: &'static [(&'static str, &'static str)],
    display: &'static [(&'static str, f64)],
) -> Unit {
    Unit { name, base, display }
}

pub(crate) const SECOND: Unit = unit("s", &[("s", "1")], &[("ms", 1e3)]);
pub(crate) const PER_SECOND: Unit = unit("1/s", &[("s", "-1")], &[]);
pub(crate) const KILOGRAM: Unit = unit("kg", &[("kg", "1")], &[("g", 1e3)]);
pub(crate) const METRE: Unit = unit("m", &[("m", "1")], &[]);
pub(crate) const METRE_PER_SECOND: Unit = unit("m/s", &[("m", "1"), ("s", "-1")], &[]);
pub(crate) const METRE_PER_SECOND_SQUARED: Unit = unit("m/s2", &[("m", "1"), ("s", "-2")], &[]);
pub(crate) const METRE_PER_SECOND_CUBED: Unit = unit("m/s3", &[("m", "1"), ("s", "-3")], &[]);
pub(crate) const RADIAN: Unit = unit("rad", &[("rad", "1")], &[("deg", DEGREES)]);
pub(crate) const RADIAN_PER_SECOND: Unit =
    unit("rad/s", &[("s", "-1"), ("rad", "1")], &[("deg/s", DEGREES), ("rpm", TURNS_PER_MINUTE)]);
pub(crate) const RADIAN_PER_SECOND_SQUARED: Unit =
    unit("rad/s2", &[("s", "-2"), ("rad", "1")], &[("deg/s2", DEGREES)]);
pub(crate) const RADIAN_PER_SECOND_CUBED: Unit =
    unit("rad/s3", &[("s", "-3"), ("rad", "1")], &[("deg/s3", DEGREES)]);
pub(crate) const NEWTON: Unit = unit("N", &[("kg", "1"), ("m", "1"), ("s", "-2")], &[]);
pub(crate) const NEWTON_METRE: Unit = unit("N.m", &[("kg", "1"), ("m", "2"), ("s", "-2")], &[]);
pub(crate) const KILOGRAM_SQUARE_METRE: Unit = unit("kg.m2", &[("kg", "1"), ("m", "2")], &[]);
pub(crate) const NEWTON_SECOND_SQUARED: Unit = unit("N.s2", &[("kg", "1"), ("m", "1")], &[]);
pub(crate) const NEWTON_METRE_SECOND_SQUARED: Unit = unit("N.m.s2", &[("kg", "1"), ("m", "2")], &[]);
pub(crate) const NEWTON_SECOND_PER_METRE: Unit = unit("N.s/m", &[("kg", "1"), ("s", "-1")], &[]);
pub(crate) const NEWTON_SECOND_SQUARED_PER_METRE: Unit = unit("N.s2/m", &[("kg", "1")], &[]);
pub(crate) const NEWTON_SECOND_SQUARED_PER_SQUARE_METRE: Unit =
    unit("N.s2/m2", &[("kg", "1"), ("m", "-1")], &[]);
pub(crate) const VOLT: Unit = unit("V", &[("kg", "1"), ("m", "2"), ("s", "-3"), ("A", "-1")], &[]);
pub(crate) const AMPERE: Unit = unit("A", &[("A", "1")], &[]);
pub(crate) const OHM: Unit = unit("Ohm", &[("kg", "1"), ("m", "2"), ("s", "-3"), ("A", "-2")], &[]);
pub(crate) const AMPERE_SECOND: Unit = unit("A.s", &[("s", "1"), ("A", "1")], &[("A.h", 1.0 / 3600.0)]);
