//! What a user changes about the simulated world and the instruments in flight.

use serde::{Deserialize, Serialize};

use super::pushes::Pushes;
use crate::estimation::SensorErrors;
use crate::world::{WindSettings, WindShape};

/// What is simulated around the vehicle. What is `None` is as it was at the start.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Simulated {
    /// Mean speed of the wind, m/s.
    pub wind_m_s: Option<f64>,
    /// Where it comes from, degrees from north through east.
    pub wind_from_deg: Option<f64>,
    /// Standard deviation of its gusts, m/s.
    pub gusts_m_s: Option<f64>,
    /// How it changes with height and time.
    pub wind_shape: WindShape,
    /// Voltage that the resting battery is charged to, V.
    pub battery_v: Option<f64>,
    /// Rotors that are weak, the first in the lowest bit.
    pub weak_rotors: f64,
    /// Share of the thrust that they make.
    pub weak_share: f64,
    /// Errors of the instruments.
    pub errors: SensorErrors,
    /// Barometers on the board; all of them measure the same. Below 1 the vehicle does not boot whole.
    pub barometers: i8,
    /// Types of external barometers to look for, as the sum of bits of ArduPilot's parameter: one is found.
    pub outer_barometers: u32,
    /// Pushes and twists.
    pub pushes: Pushes,
}

impl Default for Simulated {
    fn default() -> Self {
        Self {
            wind_m_s: None,
            wind_from_deg: None,
            gusts_m_s: None,
            wind_shape: WindShape::default(),
            battery_v: None,
            weak_rotors: 0.0,
            weak_share: 0.0,
            errors: SensorErrors::default(),
            barometers: 2,
            outer_barometers: 0,
            pushes: Pushes::default(),
        }
    }
}

/// Where the wind comes from until it is said, degrees, as ArduPilot's simulation has it.
pub const WIND_FROM_DEG: f64 = 180.0;

impl Simulated {
    /// How many barometers tell their pressure.
    pub fn told_barometers(&self) -> u8 {
        self.barometers.max(0) as u8 + u8::from(self.outer_barometers > 0)
    }

    /// With the start in place of what has not been chosen.
    pub fn since(mut self, wind: &WindSettings, full_battery_v: f64) -> Self {
        if wind.speed_m_s > 0.0 || wind.gusts_m_s > 0.0 {
            self.wind_m_s.get_or_insert(wind.speed_m_s);
            self.wind_from_deg.get_or_insert(wind.from_rad.to_degrees());
            self.gusts_m_s.get_or_insert(wind.gusts_m_s);
        }
        self.battery_v.get_or_insert(full_battery_v);
        self
    }

    /// The wind, with the seed that it had at the start. What has not been changed since is the same number.
    pub fn wind(&self, start: &WindSettings) -> WindSettings {
        let from_deg = self.wind_from_deg.unwrap_or(WIND_FROM_DEG);
        let same = from_deg == start.from_rad.to_degrees();
        WindSettings {
            speed_m_s: self.wind_m_s.unwrap_or(start.speed_m_s),
            from_rad: if same { start.from_rad } else { from_deg.to_radians() },
            gusts_m_s: self.gusts_m_s.unwrap_or(start.gusts_m_s),
            seed: start.seed,
        }
    }
}
