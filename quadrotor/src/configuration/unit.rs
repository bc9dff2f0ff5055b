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
    /// Symbol in ASCII, as messages and ground stations show it; empty for a dimensionless number.
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::One => "",
            Self::Kilogram => "kg",
            Self::Metre => "m",
            Self::Second => "s",
            Self::Radian => "rad",
            Self::Newton => "N",
            Self::NewtonMetre => "Nm",
            Self::MetrePerSecond => "m/s",
            Self::MetrePerSecondSquared => "m/s^2",
            Self::MetrePerSecondCubed => "m/s^3",
            Self::RadianPerSecond => "rad/s",
            Self::RadianPerSecondSquared => "rad/s^2",
            Self::RadianPerSecondCubed => "rad/s^3",
            Self::KilogramSquareMetre => "kg m^2",
            Self::NewtonSecondSquared => "N s^2",
            Self::NewtonMetreSecondSquared => "Nm s^2",
            Self::NewtonSecondPerMetre => "N s/m",
            Self::NewtonSecondSquaredPerMetre => "N s^2/m",
            Self::NewtonSecondSquaredPerSquareMetre => "N s^2/m^2",
            Self::Volt => "V",
            Self::Ampere => "A",
            Self::Ohm => "Ohm",
            Self::AmpereSecond => "A s",
        }
    }
}
