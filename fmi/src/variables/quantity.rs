//! Physical quantities, units and enumerations.

/// A physical quantity: the declared type of `Real` variables.
#[derive(Clone, Copy, Debug)]
pub struct Quantity {
    /// Name of its simple type.
    pub name: &'static str,
    /// Human-readable description.
    pub description: &'static str,
    /// Its unit; `None` if it has none.
    pub unit: Option<&'static Unit>,
    /// Unit that a person prefers to read, one of those of [`Unit::display`].
    pub display_unit: Option<&'static str>,
    /// Typical magnitude.
    pub nominal: f64,
}

/// A unit.
#[derive(Clone, Copy, Debug)]
pub struct Unit {
    /// Its name.
    pub name: &'static str,
    /// Exponents of SI base units, by name.
    pub base: &'static [(&'static str, &'static str)],
    /// Units that a person may prefer, with how many of them make one.
    pub display: &'static [(&'static str, f64)],
}

/// The items of an enumeration, the first of which counts 1.
#[derive(Clone, Copy, Debug)]
pub struct Choice {
    /// Name of the enumeration.
    pub name: &'static str,
    /// Human-readable description.
    pub description: &'static str,
    /// Name and description of each item.
    pub items: &'static [(&'static str, &'static str)],
}
