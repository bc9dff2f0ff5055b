//! How the closed attitude loop answers a commanded angle.

/// A closed attitude loop as two states: θ̈ = ω² (θ_command − θ) − 2 ζ ω θ̇.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AttitudeResponse {
    /// ω, rad/s.
    pub natural_frequency_rad_s: f64,
    /// ζ.
    pub damping: f64,
}
