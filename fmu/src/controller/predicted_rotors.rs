//! Speeds of rotors that nobody measures.

use quadrotor::Airframe;
use serde::{Deserialize, Serialize};

/// Speeds that rotors have by their commands and their lag.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct PredictedRotors {
    speed_rad_s: [f64; 4],
    /// When they had them, µs.
    time_us: u64,
}

impl PredictedRotors {
    /// At the start: in hover if they turn, else at rest.
    pub(super) fn new(airframe: &Airframe, armed: bool) -> Self {
        let speed_rad_s = if armed { airframe.balanced_rotor_speeds_rad_s() } else { [0.0; 4] };
        Self { speed_rad_s, time_us: 0 }
    }

    /// rad/s, in the order of the airframe's layout.
    pub(super) fn speed_rad_s(&self) -> [f64; 4] {
        self.speed_rad_s
    }

    /// When they have these speeds, µs.
    pub(super) fn time_us(&self) -> u64 {
        self.time_us
    }

    /// Under commands, rad/s, that were held until `time_us`: ω = ω_c + (ω₀ − ω_c) e^(−t/τ).
    pub(super) fn after(&self, airframe: &Airframe, command_rad_s: &[f64; 4], time_us: u64) -> Self {
        let elapsed_s = time_us.saturating_sub(self.time_us) as f64 / 1e6;
        let kept = (-elapsed_s / airframe.rotor_time_constant_s).exp();
        let speed_rad_s = std::array::from_fn(|rotor| {
            command_rad_s[rotor] + (self.speed_rad_s[rotor] - command_rad_s[rotor]) * kept
        });
        Self { speed_rad_s, time_us }
    }
}
