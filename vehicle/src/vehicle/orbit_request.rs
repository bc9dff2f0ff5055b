//! What an orbit is asked to be.

use serde::{Deserialize, Serialize};

/// Where the nose points on an orbit, by MAVLink's ORBIT_YAW_BEHAVIOUR.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum OrbitHeading {
    /// To the centre.
    #[default]
    Centre,
    /// Where it pointed when the orbit was asked for.
    Initial,
    /// Anywhere: it is not turned.
    Free,
    /// Along the way around.
    Travel,
    /// Where the pilot's yaw stick turns it.
    Pilot,
}

impl OrbitHeading {
    /// All of them, by their numbers from zero.
    pub const ALL: [Self; 5] = [Self::Centre, Self::Initial, Self::Free, Self::Travel, Self::Pilot];
}

/// An orbit; what is left open stays as it is on the present orbit, or is the vehicle's default.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct OrbitRequest {
    /// North and east of the centre, m.
    pub centre_m: Option<[f64; 2]>,
    /// Down, m.
    pub down_m: Option<f64>,
    /// Radius, m; negative: counter-clockwise seen from above.
    pub radius_m: Option<f64>,
    /// Speed along the circle, m/s; negative: the other way round.
    pub speed_m_s: Option<f64>,
    /// Where the nose points.
    pub heading: Option<OrbitHeading>,
    /// How far it goes around, rad; without it goes on for ever.
    pub way_rad: Option<f64>,
}

/// An orbit that is flown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrbitStatus {
    /// Its centre, NED, m.
    pub centre_m: nalgebra::Vector3<f64>,
    /// Its radius, m; negative: counter-clockwise seen from above.
    pub radius_m: f64,
}

/// Parameters of orbits that are not named by a command, and of all of them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct OrbitSettings {
    /// Radius of an orbit that names none, m; 0: ArduPilot turns on the spot.
    pub radius_m: f64,
    /// Rate of ArduPilot's circle, rad/s; positive: clockwise seen from above.
    pub rate_rad_s: f64,
    /// Options of ArduPilot's circle, as the parameter adds them up.
    pub options: u8,
    /// Largest radius that a command may ask for, m.
    pub largest_radius_m: f64,
    /// Where the nose points unless a command says it.
    pub heading: OrbitHeading,
}

impl OrbitSettings {
    /// Of [`Self::options`]: the pilot's sticks change radius and rate.
    const BY_STICKS: u8 = 1;
    /// Of [`Self::options`]: the nose points along the way around.
    const FACES_TRAVEL: u8 = 2;
    /// Of [`Self::options`]: the circle is around where the mode begins, not ahead of it.
    const BEGINS_AT_CENTRE: u8 = 4;

    /// Whether the pilot's sticks change radius and rate of ArduPilot's circle.
    pub fn sticks_change_it(&self) -> bool {
        self.options & Self::BY_STICKS != 0
    }

    /// Whether the nose of ArduPilot's circle points along the way around.
    pub fn faces_travel(&self) -> bool {
        self.options & Self::FACES_TRAVEL != 0
    }

    /// Whether ArduPilot's circle is around where its mode begins.
    pub fn begins_at_centre(&self) -> bool {
        self.options & Self::BEGINS_AT_CENTRE != 0
    }
}

/// Those of ArduPilot's CIRCLE_* and PX4's MC_ORBIT_*.
impl Default for OrbitSettings {
    fn default() -> Self {
        Self {
            radius_m: 10.0,
            rate_rad_s: 20_f64.to_radians(),
            options: 1,
            largest_radius_m: 1000.0,
            heading: OrbitHeading::Centre,
        }
    }
}
