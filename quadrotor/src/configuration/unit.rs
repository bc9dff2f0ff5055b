//! Units of parameters and outputs.

/// Unit of a parameter or output, SI.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Dimensionless.
    One,
    /// kg
    Kilogram,
    /// m
    Metre,
    /// s
    Second,
    /// rad
    Radian,
    /// N
    Newton,
    /// N·m
    NewtonMetre,
    /// m/s
    MetrePerSecond,
    /// m/s²
    MetrePerSecondSquared,
    /// m/s³
    MetrePerSecondCubed,
    /// rad/s
    RadianPerSecond,
    /// rad/s²
    RadianPerSecondSquared,
    /// rad/s³
    RadianPerSecondCubed,
    /// kg·m²
    KilogramSquareMetre,
    /// N·s²
    NewtonSecondSquared,
    /// N·m·s²
    NewtonMetreSecondSquared,
    /// N·s/m
    NewtonSecondPerMetre,
    /// N·s²/m
    NewtonSecondSquaredPerMetre,
    /// N·s²/m²
    NewtonSecondSquaredPerSquareMetre,
    /// V
    Volt,
    /// A
    Ampere,
    /// Ω
    Ohm,
    /// A·s
    AmpereSecond,
}

impl Unit {
    /// Symbol, as messages and documentation show it; empty for a dimensionless number.
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::One => "",
            Self::Kilogram => "kg",
            Self::Metre => "m",
            Self::Second => "s",
            Self::Radian => "rad",
            Self::Newton => "N",
            Self::NewtonMetre => "N·m",
            Self::MetrePerSecond => "m/s",
            Self::MetrePerSecondSquared => "m/s²",
            Self::MetrePerSecondCubed => "m/s³",
            Self::RadianPerSecond => "rad/s",
            Self::RadianPerSecondSquared => "rad/s²",
            Self::RadianPerSecondCubed => "rad/s³",
            Self::KilogramSquareMetre => "kg·m²",
            Self::NewtonSecondSquared => "N·s²",
            Self::NewtonMetreSecondSquared => "N·m·s²",
            Self::NewtonSecondPerMetre => "N·s/m",
            Self::NewtonSecondSquaredPerMetre => "N·s²/m",
            Self::NewtonSecondSquaredPerSquareMetre => "N·s²/m²",
            Self::Volt => "V",
            Self::Ampere => "A",
            Self::Ohm => "Ω",
            Self::AmpereSecond => "A·s",
        }
    }
}
