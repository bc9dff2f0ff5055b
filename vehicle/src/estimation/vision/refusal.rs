//! Why nothing comes of an estimate from outside.

/// The reason.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VisionRefusal {
    /// With ideal sensors the motion is known.
    IdealSensors,
    /// Nothing that it has is fused, by the parameters.
    NotUsed,
    /// It says what cannot be: numbers that are not finite, farther away than 100 km or faster than 200 m/s.
    Impossible,
    /// It says of itself that it is not good enough, both in %.
    Poor {
        /// How good it is.
        quality: i8,
        /// How good it has to be.
        least: i8,
    },
}
