//! When a vehicle counts as crashed.

use serde::{Deserialize, Serialize};

/// Parameters of the crash check and, in PX4's convention, of its failure detector.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CrashSettings {
    /// Whether a vehicle that lies tipped over is disarmed.
    pub check: bool,
    /// A roll beyond this, rad, for so long, s, is a failure; 0: never.
    pub roll_rad: f64,
    /// The same for pitch.
    pub pitch_rad: f64,
    /// How long the roll must last, s.
    pub roll_s: f64,
    /// How long the pitch must last, s.
    pub pitch_s: f64,
    /// So long after arming, s, a failure stops the rotors.
    pub lockdown_s: f64,
    /// PX4's circuit breaker of flight termination: with [`CIRCUIT_BROKEN`] a failure in flight is only told.
    pub circuit_breaker: u32,
}

/// The number that breaks the circuit.
pub const CIRCUIT_BROKEN: u32 = 121_212;

/// PX4's: 60°, 0.3 s, 3 s, told only.
impl Default for CrashSettings {
    fn default() -> Self {
        Self {
            check: true,
            roll_rad: 60_f64.to_radians(),
            pitch_rad: 60_f64.to_radians(),
            roll_s: 0.3,
            pitch_s: 0.3,
            lockdown_s: 3.0,
            circuit_breaker: CIRCUIT_BROKEN,
        }
    }
}
