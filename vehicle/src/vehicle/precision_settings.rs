//! When a landing goes to a target that is seen, and the target that is simulated.

use serde::{Deserialize, Serialize};

/// The beam of the simulated target.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum BeaconBeam {
    /// As wide at all heights.
    Cylinder,
    /// As wide as the height share of its greatest height.
    Cone,
    /// A ball.
    Sphere,
}

/// Parameters of precision landing (ArduPilot: PLND_…) and of the simulated target (SIM_PLD_…).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PrecisionSettings {
    /// Whether targets count.
    pub enabled: bool,
    /// ArduPilot's number of the sensor.
    pub sensor: u8,
    /// Farther than this beside the target, m, the vehicle does not sink; 0: anywhere it does.
    pub farthest_m: f64,
    /// Whether a target is simulated.
    pub simulated: bool,
    /// Where, degrees; both zero: where the vehicle started.
    pub latitude_deg: f64,
    #[allow(missing_docs)] // With the one above.
    pub longitude_deg: f64,
    /// Its height above the start, m.
    pub height_m: f64,
    /// How high above it, and how far beside it, it is seen, m.
    pub beam_height_m: f64,
    #[allow(missing_docs)] // With the one above.
    pub beam_radius_m: f64,
    /// The shape of its beam.
    pub beam: BeaconBeam,
}

/// ArduPilot's.
impl Default for PrecisionSettings {
    fn default() -> Self {
        Self {
            enabled: false,
            sensor: 0,
            farthest_m: 2.5,
            simulated: false,
            latitude_deg: 0.0,
            longitude_deg: 0.0,
            height_m: 0.0,
            beam_height_m: 15.0,
            beam_radius_m: 10.0,
            beam: BeaconBeam::Cylinder,
        }
    }
}

/// Numbers of the sensors.
const MAVLINK: u8 = 1;
const INFRARED: u8 = 2;
const SIMULATED: u8 = 4;

impl PrecisionSettings {
    /// Whether LANDING_TARGET counts.
    pub fn hears(&self) -> bool {
        self.enabled && self.sensor == MAVLINK
    }

    /// Whether the simulated target counts.
    pub fn sees(&self) -> bool {
        self.enabled && self.simulated && matches!(self.sensor, INFRARED | SIMULATED)
    }

    /// Whether the simulated target is seen from so far beside it, m, and above it, m.
    pub fn is_in_beam(&self, beside_m: f64, above_m: f64) -> bool {
        let (radius_m, top_m) = (self.beam_radius_m, self.beam_height_m);
        match self.beam {
            _ if above_m < 0.0 || above_m > top_m => false,
            BeaconBeam::Cylinder => beside_m <= radius_m,
            BeaconBeam::Cone => beside_m * top_m <= radius_m * above_m,
            BeaconBeam::Sphere => libm::hypot(beside_m, above_m) <= radius_m,
        }
    }
}
