//! A parachute: it is released, and opens a moment later if its output fires it. Its drag acts at the centre of mass.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Sink rate at which it carries the vehicle, m/s: a usual one of rescue parachutes.
const SINK_M_S: f64 = 4.5;
/// How long its output fires, µs.
const FIRES_US: u64 = 2_000_000;
/// A longer pulse fires the simulated one, µs: ArduPilot's simulation.
const FIRED_US: u16 = 1250;

/// How it is set up (CHUTE_…, SIM_PARA_…).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ParachuteSettings {
    /// Whether it may open.
    pub enabled: bool,
    /// Pulses that open it and that do not, µs.
    pub on_us: u16,
    #[allow(missing_docs)] // With the one above.
    pub off_us: u16,
    /// Least height above home at which it opens, m; 0: any.
    pub least_height_m: f64,
    /// Time between its release, which stops the rotors, and its pulse, s.
    pub delay_s: f64,
    /// Sink rate at which it is released by itself, m/s; 0: none.
    pub fastest_m_s: f64,
    /// Whether there is one.
    pub is_fitted: bool,
    /// The output that it is connected to, from 1.
    pub output: i8,
}

/// ArduPilot's.
impl Default for ParachuteSettings {
    fn default() -> Self {
        Self {
            enabled: false,
            on_us: 1300,
            off_us: 1100,
            least_height_m: 10.0,
            delay_s: 0.5,
            fastest_m_s: 0.0,
            is_fitted: false,
            output: -1,
        }
    }
}

/// What can be asked of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParachuteOrder {
    /// It may not open.
    Disable,
    /// It may.
    Enable,
    /// It opens now, if it may.
    Release,
}

/// The parachute.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Parachute {
    /// When it was released, µs.
    released_us: Option<u64>,
    open: bool,
}

impl Parachute {
    /// Releases it.
    pub fn release(&mut self, now_us: u64) {
        self.released_us.get_or_insert(now_us);
    }

    /// Whether it has been released.
    pub fn is_released(&self) -> bool {
        self.released_us.is_some()
    }

    /// The pulse of its output, µs.
    pub fn pulse_us(&self, settings: &ParachuteSettings, now_us: u64) -> u16 {
        let fires = self.released_us.is_some_and(|released_us| {
            let from_us = released_us + (settings.delay_s * 1e6) as u64;
            (from_us..from_us + FIRES_US).contains(&now_us)
        });
        if fires { settings.on_us } else { settings.off_us }
    }

    /// Sees the pulse of the output that it is connected to, µs. Returns whether it opens now.
    pub fn see_pulse(&mut self, settings: &ParachuteSettings, pulse_us: u16) -> bool {
        let opens = settings.is_fitted && !self.open && pulse_us > FIRED_US;
        self.open |= opens;
        opens
    }

    /// Its drag at a velocity through the air, m/s, under a weight, N: NED, N.
    pub fn drag_n(&self, through_air_m_s: &Vector3<f64>, weight_n: f64) -> Vector3<f64> {
        if !self.open {
            return Vector3::zeros();
        }
        -through_air_m_s * (through_air_m_s.norm() * weight_n / (SINK_M_S * SINK_M_S))
    }
}

#[cfg(test)]
mod tests {
    use super::{Parachute, ParachuteSettings, SINK_M_S, Vector3};

    #[test]
    fn it_opens_after_its_delay_and_carries_the_weight_at_its_sink_rate() {
        let settings = ParachuteSettings { is_fitted: true, ..ParachuteSettings::default() };
        let mut parachute = Parachute::default();
        assert_eq!(parachute.pulse_us(&settings, 10_000_000), 1100);
        parachute.release(1_000_000);
        let pulses = [1_499_999, 1_500_000, 3_499_999, 3_500_000];
        assert_eq!(pulses.map(|now_us| parachute.pulse_us(&settings, now_us)), [1100, 1300, 1300, 1100]);
        let sinking = Vector3::new(0.0, 0.0, SINK_M_S);
        assert_eq!(parachute.drag_n(&sinking, 7.0), Vector3::zeros());
        assert_eq!(
            [1100, 1300, 1300].map(|pulse| parachute.see_pulse(&settings, pulse)),
            [false, true, false]
        );
        assert!((parachute.drag_n(&sinking, 7.0) + Vector3::new(0.0, 0.0, 7.0)).norm() < 1e-12);
    }

    #[test]
    fn none_that_is_not_fitted_opens() {
        assert!(!Parachute::default().see_pulse(&ParachuteSettings::default(), 1900));
    }
}
